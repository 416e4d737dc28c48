# SPDX-License-Identifier: Apache-2.0
umbrick_tests(image annotate_test.cpp colour_map_test.cpp display_test.cpp exr_test.cpp flip_test.cpp image_difference_test.cpp png_test.cpp ssim_test.cpp)
