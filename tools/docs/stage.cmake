# Puts together what the pages are made of, in the folders of the checkout, so that links lead where they lead there:
#   cmake -DTOP=<checkout> -DPAGES=FOLDER -DPROGRAM=umbrick -P stage.cmake
# SPDX-License-Identifier: Apache-2.0
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${PAGES})
file(GLOB pages RELATIVE ${TOP} ${TOP}/README.md ${TOP}/*/README.md ${TOP}/*/*/README.md ${TOP}/tools/docs/*.md
     ${TOP}/assets/pictures/* ${TOP}/assets/scenes/* ${TOP}/LICENSE ${TOP}/tools/*.txt)
list(FILTER pages EXCLUDE REGEX "^(build|out)/")
foreach(page IN LISTS pages)
  get_filename_component(folder ${page} DIRECTORY)
  file(COPY ${TOP}/${page} DESTINATION ${PAGES}/${folder})
endforeach()
file(RENAME ${PAGES}/tools/docs/index.md ${PAGES}/index.md)
file(COPY ${TOP}/tools/docs/conf.py DESTINATION ${PAGES})

# The picture of the rooms. What follows by way of another room has no arrow of its own.
set(dot ${PAGES}/tools/docs/rooms.dot)
execute_process(COMMAND ${CMAKE_COMMAND} -DTOP=${TOP} -DOUTPUT=${dot} -P ${TOP}/tools/docs/rooms_graph.cmake COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND tred ${dot} COMMAND dot -Tsvg -o ${PAGES}/tools/docs/rooms.svg COMMAND_ERROR_IS_FATAL ANY)

# The way to the pages that Doxygen makes.
file(WRITE ${PAGES}/headers.md "# The headers\n\nEach public header says what it gives, in which units, and what it throws:\n\n"
     "- <a href=\"api/files.html\">the headers, room by room</a>\n- <a href=\"api/annotated.html\">classes and structs</a>\n"
     "- <a href=\"api/namespacemembers_func.html\">functions</a>\n")

# One page for each command, of what its help says.
execute_process(COMMAND ${PROGRAM} --help OUTPUT_VARIABLE help COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE "^.*\nSubcommands:\n" "\n" list "${help}")
string(REGEX MATCHALL "\n  [a-z]+ " commands "${list}")
string(REGEX MATCHALL "[a-z]+" commands "${commands}")
set(index "# Commands\n\nWhat each command says by `--help`. [tools/README.md](../tools/README.md) has examples of each, and what stands behind the options.\n\n")
string(APPEND index "```{toctree}\n:maxdepth: 1\n\n")
foreach(command IN LISTS commands)
  execute_process(COMMAND ${PROGRAM} ${command} --help COMMAND python3 ${TOP}/tools/docs/wrap_help.py OUTPUT_VARIABLE help COMMAND_ERROR_IS_FATAL ANY)
  file(WRITE ${PAGES}/commands/${command}.md "# umbrick ${command}\n\n```text\n${help}```\n")
  string(APPEND index "${command}\n")
endforeach()
file(WRITE ${PAGES}/commands/index.md "${index}```\n")
