# Writes the pages of the manual and the completion of shells, where Debian's man and shells look below /usr/share:
#   cmake -DPROGRAM=... -DMANUAL=FOLDER -DCOMPLETION=FOLDER -P write_manual.cmake
# SPDX-License-Identifier: Apache-2.0
cmake_minimum_required(VERSION 3.25)
# Tests look for leaks, with what they know of drivers.
set(ENV{ASAN_OPTIONS} detect_leaks=0)
file(REMOVE_RECURSE ${MANUAL} ${COMPLETION})
execute_process(COMMAND ${PROGRAM} manual --folder ${MANUAL} COMMAND_ERROR_IS_FATAL ANY)
file(GLOB pages ${MANUAL}/*.1)
execute_process(COMMAND gzip -9n ${pages} COMMAND_ERROR_IS_FATAL ANY)
function(write_completion shell file)
  execute_process(COMMAND ${PROGRAM} completion ${shell} OUTPUT_VARIABLE script COMMAND_ERROR_IS_FATAL ANY)
  file(WRITE ${COMPLETION}/${file} "${script}")
endfunction()
write_completion(bash bash-completion/completions/umbrick)
write_completion(zsh zsh/vendor-completions/_umbrick)
write_completion(fish fish/vendor_completions.d/umbrick.fish)
