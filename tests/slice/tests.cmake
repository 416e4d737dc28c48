# SPDX-License-Identifier: Apache-2.0
umbrick_tests(slice proxy_slices_test.cpp)
