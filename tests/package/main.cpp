// What a user of the library would write first: a preset, a check, an error.
// SPDX-License-Identifier: Apache-2.0
#include <umbrick/core/error.h>
#include <umbrick/optics/transfer_function.h>
#include <umbrick/shade/slice_renderer.h>
#include <umbrick/vdb/read_grid.h>

#include <iostream>

int main() {
  const umbrick::TransferFunction bone = umbrick::loadTransferFunction("ct-bone");
  try {
    umbrick::readScalarGrid("/no/such/file.vdb");
  } catch (const umbrick::IoError& error) {
    std::cout << error.what() << '\n';
    return bone(3000).sigma_t > 0 ? 0 : 1;
  }
  return 1;
}
