# Rules that every target shares: ccache, warnings, sanitizers, rooms, embedded text.
# SPDX-License-Identifier: Apache-2.0

# Compiles by way of ccache, if it is installed. It keeps what uses a precompiled header only if it may overlook when that
# was made, and if the compiler names the header in preprocessed text. Another checkout finds what this one has compiled.
macro(umbrick_use_ccache)
  find_program(CCACHE ccache)
  if(CCACHE)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
        CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1
        CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime ${CCACHE})
    add_compile_options($<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
  endif()
endmacro()

# Flags of every target of the project, kept off its users.
function(umbrick_flags target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor)
  # GCC 12 sees overlaps that are not there in std::string (its bug 105329).
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
  get_target_property(unity ${target} UNITY_BUILD)
  if(unity)
    # Where many files are one, GCC takes them for headers, whose types must not lie in unnamed namespaces, and 12 warns
    # of code of std::vector and std::string that is never reached. Builds of single files keep these warnings.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>
                                             $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds>
                                             $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow>)
  endif()
  # The same source line gives the same number wherever it is inlined: neighbouring bricks must agree to the bit.
  target_compile_options(${target} PRIVATE -ffp-contract=off)
  if(UMBRICK_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(UMBRICK_SANITIZE)
    # Accesses to memory are the address sanitizer's: to look at each pointer a second time, and at the type behind it,
    # is half of the compiler's work.
    target_compile_options(${target} PRIVATE -fsanitize=address,undefined
                                             -fno-sanitize=null,alignment,object-size,pointer-overflow,vptr
                                             -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
    # With the checks in between, GCC loses track of what the standard library initialises (its bug 105562).
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
    target_link_options(${target} PRIVATE -fsanitize=address,undefined)
  endif()
endfunction()

# Keeps sources of a target from its precompiled header. That holds OpenVDB, which files that see it compile twice as
# fast with; those that do not would load it for nothing, which takes longer than they do.
function(umbrick_without_openvdb target)
  set_source_files_properties(${ARGN} TARGET_DIRECTORY ${target} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
endfunction()

# Lets a program share the libraries' precompiled header. @param ARGN  its sources that do not include OpenVDB
function(umbrick_reuse_openvdb target)
  target_precompile_headers(${target} REUSE_FROM umbrick_volume)
  target_compile_options(${target} PRIVATE -fPIC)  # as the library: the compiler takes the header only then
  if(ARGN)
    umbrick_without_openvdb(${target} ${ARGN})
  endif()
endfunction()

# A library of rooms: umbrick_library(volume core ingest) makes umbrick::volume from src/core and src/ingest.
# A program that uses some rooms of it links no foreign library that only the others need.
# Static, or shared with -DBUILD_SHARED_LIBS=ON: a shared one is good for all programs that were linked to the same minor version.
function(umbrick_library name)
  set(UMBRICK_LIBRARY umbrick_${name})
  add_library(${UMBRICK_LIBRARY})
  add_library(umbrick::${name} ALIAS ${UMBRICK_LIBRARY})
  # Where many files are compiled as one, they are of one room: its unnamed namespaces are one then.
  set_target_properties(${UMBRICK_LIBRARY} PROPERTIES EXPORT_NAME ${name} UNITY_BUILD_MODE GROUP
                        VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  # Without a macro of its own, a shared library can use the precompiled header of another one.
  set_target_properties(${UMBRICK_LIBRARY} PROPERTIES DEFINE_SYMBOL "")
  umbrick_flags(${UMBRICK_LIBRARY})
  target_include_directories(${UMBRICK_LIBRARY} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:include>
                                                PRIVATE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/shaders)
  target_compile_features(${UMBRICK_LIBRARY} PUBLIC cxx_std_20)
  target_link_options(${UMBRICK_LIBRARY} INTERFACE LINKER:--as-needed)
  foreach(room ${ARGN})
    add_subdirectory(src/${room})
  endforeach()
endfunction()

# A room: its sources become part of its library. Those that include OpenVDB, through headers or not, stand apart.
#   umbrick_room(SOURCES a.cpp b.cpp OPENVDB c.cpp)
function(umbrick_room)
  cmake_parse_arguments(ROOM "" "" "SOURCES;OPENVDB" ${ARGN})
  list(TRANSFORM ROOM_SOURCES PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/ REGEX "^[^/]")
  list(TRANSFORM ROOM_OPENVDB PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/ REGEX "^[^/]")
  target_sources(${UMBRICK_LIBRARY} PRIVATE ${ROOM_SOURCES} ${ROOM_OPENVDB})
  get_filename_component(room ${CMAKE_CURRENT_SOURCE_DIR} NAME)
  foreach(kind SOURCES OPENVDB)
    set(count 0)
    set(last_folder "")
    foreach(source IN LISTS ROOM_${kind})
      # Those of a folder of their own, as what reads DICOM, become files of their own, so that programs link less.
      get_filename_component(folder ${source} DIRECTORY)
      if(NOT folder STREQUAL last_folder)
        math(EXPR count "(${count} + ${CMAKE_UNITY_BUILD_BATCH_SIZE} - 1) / ${CMAKE_UNITY_BUILD_BATCH_SIZE} * ${CMAKE_UNITY_BUILD_BATCH_SIZE}")
        set(last_folder ${folder})
      endif()
      math(EXPR batch "${count} / ${CMAKE_UNITY_BUILD_BATCH_SIZE}")
      set_source_files_properties(${source} TARGET_DIRECTORY ${UMBRICK_LIBRARY} PROPERTIES UNITY_GROUP ${room}_${kind}_${batch})
      math(EXPR count "${count} + 1")
    endforeach()
  endforeach()
  if(ROOM_SOURCES)
    umbrick_without_openvdb(${UMBRICK_LIBRARY} ${ROOM_SOURCES})
  endif()
endfunction()

# A source that the build writes becomes part of a library.
function(umbrick_add_generated target name output)
  # A target of its own, since the library is declared in another folder than the rule that writes the source.
  add_custom_target(umbrick_${name} DEPENDS ${output})
  set_source_files_properties(${output} TARGET_DIRECTORY ${target} PROPERTIES GENERATED TRUE)
  add_dependencies(${target} umbrick_${name})
  target_sources(${target} PRIVATE ${output})
  umbrick_without_openvdb(${target} ${output})
  set_source_files_properties(${output} TARGET_DIRECTORY ${target} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# Text files that become part of a library: umbrick_embed(umbrick_render shaderText BASE ... FILES ...) writes a .cpp
# that defines
#   std::string_view umbrick::FUNCTION(std::string_view name)   the text of one file, empty if there is none
#   std::vector<std::string> umbrick::FUNCTIONNames()           the names there are
# The name of a file is its path below BASE.
function(umbrick_embed target function)
  cmake_parse_arguments(EMBED "" "BASE" "FILES" ${ARGN})
  set(output ${CMAKE_CURRENT_BINARY_DIR}/${function}.cpp)
  list(TRANSFORM EMBED_FILES PREPEND ${EMBED_BASE}/ OUTPUT_VARIABLE paths)
  string(REPLACE ";" "," names "${EMBED_FILES}")
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DFUNCTION=${function} -DBASE=${EMBED_BASE} -DNAMES=${names} -DOUTPUT=${output}
            -P ${PROJECT_SOURCE_DIR}/src/embed.cmake
    DEPENDS ${paths} ${PROJECT_SOURCE_DIR}/src/embed.cmake
    VERBATIM)
  umbrick_add_generated(${target} ${function} ${output})
endfunction()

# A file of bytes that becomes part of a library: umbrick_embed_bytes(umbrick_render labelFont FILE /.../Vera.ttf) writes a
# .cpp that defines
#   std::span<const unsigned char> umbrick::FUNCTION()
function(umbrick_embed_bytes target function)
  cmake_parse_arguments(EMBED "" "FILE" "" ${ARGN})
  set(output ${CMAKE_CURRENT_BINARY_DIR}/${function}.cpp)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DFUNCTION=${function} -DINPUT=${EMBED_FILE} -DOUTPUT=${output}
            -P ${PROJECT_SOURCE_DIR}/src/embed_bytes.cmake
    DEPENDS ${EMBED_FILE} ${PROJECT_SOURCE_DIR}/src/embed_bytes.cmake
    VERBATIM)
  umbrick_add_generated(${target} ${function} ${output})
endfunction()

# A library without a CMake package: sets PREFIX_INCLUDE_DIR and PREFIX_LIBRARY, or says which Debian package has it.
function(umbrick_find_library prefix header library package)
  find_path(${prefix}_INCLUDE_DIR ${header})
  find_library(${prefix}_LIBRARY ${library})
  if(NOT ${prefix}_INCLUDE_DIR OR NOT ${prefix}_LIBRARY)
    message(FATAL_ERROR "${header} or lib${library} is missing: install ${package} (tools/setup installs all that is needed)")
  endif()
endfunction()
