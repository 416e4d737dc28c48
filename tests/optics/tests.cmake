# SPDX-License-Identifier: Apache-2.0
umbrick_tests(optics black_body_test.cpp directions_test.cpp gradient_filter_test.cpp medium_test.cpp transfer_function_test.cpp transfer_json_test.cpp transfer_stretches_test.cpp)
