// umbrick convert: a volume of any format that is read to a sparse .vdb, with the loss it cost.
// SPDX-License-Identifier: Apache-2.0
#include "umbrick/convert/convert.h"

#include <tbb/global_control.h>

#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "command.h"
#include "convert_options.h"
#include "convert_progress.h"
#include "convert_report.h"
#include "convert_sequence.h"
#include "option_words.h"
#include "output_option.h"
#include "umbrick/convert/convert_frames.h"
#include "umbrick/convert/holds_grids.h"
#include "umbrick/convert/plan_volumes.h"
#include "umbrick/core/printable.h"
#include "umbrick/core/stopwatch.h"

namespace umbrick::tools {
namespace {

struct Outcome {
  std::int64_t bytesIn = 0, bytesOut = 0;
};

int plan(const ConvertCommand& command, const ConvertOptions& options, ProgressBar& bar) {
  if (holdGrids(command.inputs, options.source))
    throw UsageError(command.inputs.front().string() +
                     ": --plan is for volumes: of a grid umbrick info tells what it holds");
  const std::vector<VolumePlan> plans = planVolumes(command.inputs, options);
  bar.clear();
  for (const VolumePlan& one : plans) printPlan(one, options.output.codec.value_or(VdbCodec::blosc));
  return 0;
}

Outcome convertOne(const ConvertCommand& command, const ConvertOptions& options, ProgressBar& bar) {
  const ConvertReport report = convert(command.inputs, command.output, options);
  bar.clear();
  printNotes(report);
  printWarnings(report);
  printReport(report, options);
  return {report.bytesIn, report.bytesOut};
}

Outcome convertSequence(const FrameSequence& sequence, const ConvertOptions& options, ProgressBar& bar) {
  Outcome outcome;
  std::set<std::string> said;
  convertFrames(sequence.frames, options, [&](const FrameFiles& frame, const ConvertReport& report) {
    bar.clear();
    printNotes(report, &said);
    printWarnings(report);
    printFrame(report);
    // Frames inside of one file have its bytes together.
    outcome.bytesIn = frame.inside ? report.bytesIn : outcome.bytesIn + report.bytesIn;
    outcome.bytesOut += report.bytesOut;
  });
  return outcome;
}

int run(ConvertCommand command) {
  const Stopwatch stopwatch;
  ConvertOptions options = settledOptions(command);
  std::optional<tbb::global_control> limit;
  if (command.threads > 0)
    limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(command.threads));
  const StopRequest stop;
  ProgressBar bar("converting");
  options.progress = showProgress(bar, stop,
                                  command.plan ? command.inputs.front().string() + ": interrupted"
                                               : command.output.string() + ": interrupted before it was written");
  if (command.plan) return plan(command, options, bar);
  holdGrids(command.inputs, options.source);  // refuses what no sequence is either
  const std::optional<FrameSequence> sequence = findSequence(command, options);
  if (!sequence) prepareOutput(command.output, command.force);
  for (std::size_t i = 0; sequence && i < sequence->frames.size(); ++i) {
    std::filesystem::path frame = sequence->frames[i].output;
    prepareOutput(frame, command.force);
  }
  const Outcome outcome = sequence ? convertSequence(*sequence, options, bar) : convertOne(command, options, bar);
  std::cout << printable(command.output.string()) << ": ";
  if (sequence) std::cout << sequence->frames.size() << (sequence->frames.size() == 1 ? " frame, " : " frames, ");
  std::cout << outcome.bytesIn << " bytes in, " << outcome.bytesOut << " bytes out, "
            << std::lround(stopwatch.elapsedMs()) << " ms\n";
  return 0;
}

}  // namespace

Command addConvert(CLI::App& app) {
  const auto command = std::make_shared<ConvertCommand>();
  CLI::App* sub = app.add_subcommand(
      "convert",
      "Turn volumes of many formats, a .vdb or a .nvdb into a sparse .vdb or another format; prints what was lost.");
  addConvertOptions(*sub, command);
  return {sub, [command] { return asUsage([&] { return run(*command); }); }};
}

}  // namespace umbrick::tools
