# SPDX-License-Identifier: Apache-2.0
umbrick_tests(render OPENVDB emission_volume_test.cpp gradient_opacity_test.cpp orientation_test.cpp progress_gl_test.cpp suggest_transfer_test.cpp volume_file_test.cpp volume_frames_test.cpp volume_view_gl_test.cpp)
