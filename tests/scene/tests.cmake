# SPDX-License-Identifier: Apache-2.0
umbrick_tests(scene scene_test.cpp lights_test.cpp environment_test.cpp)
