// SPDX-License-Identifier: Apache-2.0
#include "formats.h"

#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "umbrick/ingest/open_volume.h"

namespace umbrick::tools {
namespace {

// What to say of some formats on the command line.
std::string hint(const std::string& format) {
  if (format == "DICOM") return "; --series picks one";
  if (format == "raw") return "; needs --dims and --type";
  return {};
}

std::vector<FormatRow> rows() {
  std::vector<FormatRow> all = listFormats();
  for (FormatRow& row : all) row.reads += hint(row.name);
  all.push_back({"OpenVDB", {".vdb"}, "scalar grids, each by itself"});
  all.push_back({"NanoVDB", {".nvdb"}, "scalar grids and quantised ones; plain, ZIP and Blosc"});
  return all;
}

void printText() {
  for (const FormatRow& row : rows()) {
    std::cout << row.name << ": ";
    for (const std::string& extension : row.extensions) std::cout << extension << ' ';
    std::cout << "- " << row.reads << '\n';
  }
}

void printJson() {
  nlohmann::ordered_json list = nlohmann::json::array();
  for (const FormatRow& row : rows())
    list.push_back(nlohmann::ordered_json{{"name", row.name}, {"extensions", row.extensions}, {"reads", row.reads}});
  std::cout << list.dump(2) << '\n';
}

}  // namespace

void addListFormats(CLI::App& command) {
  // The option acts as it is parsed, like --help, so that it needs no input.
  command
      .add_flag_function(
          "--list-formats{1},--list-formats-json{2}",
          [](std::int64_t form) {
            form == 1 ? printText() : printJson();
            throw CLI::Success();
          },
          "list the formats that are read, one a line or as JSON, and exit")
      ->trigger_on_parse();
}

}  // namespace umbrick::tools
