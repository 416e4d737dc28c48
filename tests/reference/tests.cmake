# SPDX-License-Identifier: Apache-2.0
umbrick_tests(reference closed_forms_test.cpp agreement_test.cpp convergence_test.cpp pixel_samples_test.cpp OPENVDB emission_test.cpp visibility_test.cpp
              lights_test.cpp brute_force_test.cpp)
