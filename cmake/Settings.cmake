# SPDX-License-Identifier: Apache-2.0
# What every target of ours is built with.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
# Frame pointers, so that a profile has call stacks.
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG -fno-omit-frame-pointer")
set(CMAKE_C_FLAGS_RELEASE "-O2 -DNDEBUG -fno-omit-frame-pointer")
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
set_property(GLOBAL PROPERTY GLOBAL_DEPENDS_NO_CYCLES ON)

set(WEFT_SANITIZE "" CACHE STRING "Sanitizers, as in -fsanitize=: address,undefined or thread")
option(WEFT_PLAIN_THREADS "parallel_for on plain threads instead of oneTBB, which ThreadSanitizer cannot see into" OFF)
option(WEFT_FUZZERS "Build the libFuzzer programs (clang only)" OFF)
set(WEFT_BUILT "" CACHE PATH "Build folder whose libraries stand in for those that no sanitizer is to watch")
set(WEFT_FUZZ_SECONDS 30 CACHE STRING "How long each libFuzzer program runs as a test")

add_library(weft_settings INTERFACE)
target_include_directories(weft_settings INTERFACE ${CMAKE_SOURCE_DIR})
target_compile_options(weft_settings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Werror
  -ffp-contract=off)  # the same bytes from every build: operations fuse only where a kernel says so
# GCC 12 reports these inside its own <string> and <regex>, depending on what it inlined.
target_compile_options(weft_settings INTERFACE
  $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds -Wno-maybe-uninitialized -Wno-restrict -Wno-stringop-overflow
  -Wno-stringop-overread>)
if(WEFT_JOINED AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # A class of one file whose member is of that file's unnamed namespace: GCC takes the file for a header.
  target_compile_options(weft_settings INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wno-subobject-linkage>)
endif()
target_link_options(weft_settings INTERFACE -fuse-ld=lld)
target_link_libraries(weft_settings INTERFACE fmt::fmt)  # in the precompiled headers, so alike in every target
if(WEFT_FUZZERS)
  target_compile_options(weft_settings INTERFACE -fsanitize=fuzzer-no-link)
endif()
if(WEFT_SANITIZE)
  target_compile_options(weft_settings INTERFACE
    -fsanitize=${WEFT_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(weft_settings INTERFACE -fsanitize=${WEFT_SANITIZE})
  # Kernels are one source for all targets: two of them, with vectors and without, are watched.
  target_compile_definitions(weft_settings INTERFACE "HWY_DISABLED_TARGETS=(HWY_SSSE3|HWY_SSE4|HWY_AVX3)")
elseif(NOT WEFT_FUZZERS)
  # What nothing calls is 4 percent of a program, and functions of the same bytes are 3.
  target_link_options(weft_settings INTERFACE -Wl,--gc-sections -Wl,--icf=all)
endif()

# Headers that most units read, compiled once. Libraries are optimised for what they measure, tests for the time that
# they take to compile.
set(WEFT_TEST_OPTIONS $<$<CONFIG:Release>:-O1>)
function(weft_precompile name)
  cmake_parse_arguments(ARG "" "" "HEADERS;DEPENDS;OPTIONS" ${ARGN})
  file(WRITE ${CMAKE_BINARY_DIR}/${name}.cpp "")
  add_library(${name} OBJECT ${CMAKE_BINARY_DIR}/${name}.cpp)
  target_link_libraries(${name} PRIVATE weft_settings ${ARG_DEPENDS})
  target_compile_options(${name} PRIVATE ${ARG_OPTIONS})
  target_precompile_headers(${name} PRIVATE ${ARG_HEADERS})
endfunction()
set(everywhere <algorithm> <array> <chrono> <cmath> <cstdint> <filesystem> <functional> <map> <memory> <mutex>
  <optional> <span> <stop_token> <string> <string_view> <thread> <utility> <variant> <vector> <fmt/format.h>
  <nlohmann/json.hpp>)
weft_precompile(weft_precompiled HEADERS ${everywhere} DEPENDS nlohmann_json::nlohmann_json)
weft_precompile(weft_precompiled_tests
  HEADERS ${everywhere} <gmock/gmock.h> <gtest/gtest.h>
  DEPENDS nlohmann_json::nlohmann_json GTest::gtest_main GTest::gmock
  OPTIONS ${WEFT_TEST_OPTIONS})

# Where jobs and not mathematics stand (docs/architecture.md). Nothing of it is measured: time to compile is worth more
# than speed, and sanitizers watch it.
set(WEFT_UPPER_HALVES "^(calibration/(guide|run)|exchange/export|library/(chain|import|run)|material/(assets|read|run)|solve/(files|input|report|run|session))$")

# weft_library(NAME DEPENDS ... SOURCES ...): one folder, one target. PLAIN: without the precompiled headers, for C and
# for what is compiled with other options. APART: each file by itself. With WEFT_BUILT a library that no sanitizer is to
# watch is not compiled: its archive is that of this other build.
function(weft_library name)
  cmake_parse_arguments(ARG "PLAIN;APART" "" "SOURCES;DEPENDS;PRIVATE_DEPENDS;OPTIONS" ${ARGN})
  cmake_path(RELATIVE_PATH CMAKE_CURRENT_SOURCE_DIR BASE_DIRECTORY ${CMAKE_SOURCE_DIR} OUTPUT_VARIABLE folder)
  if(WEFT_BUILT AND folder MATCHES "^(bench|calibration|library/batch|material|report|simulator|solve|solver)(/|$)"
     AND NOT folder MATCHES "${WEFT_UPPER_HALVES}")
    add_library(${name} INTERFACE)
    target_link_libraries(${name} INTERFACE weft_settings ${WEFT_BUILT}/${folder}/lib${name}.a
      ${ARG_DEPENDS} ${ARG_PRIVATE_DEPENDS})
    return()
  endif()
  add_library(${name} STATIC ${ARG_SOURCES})
  target_link_libraries(${name} PUBLIC weft_settings ${ARG_DEPENDS} PRIVATE ${ARG_PRIVATE_DEPENDS})
  target_compile_options(${name} PRIVATE ${ARG_OPTIONS})
  if(folder MATCHES "${WEFT_UPPER_HALVES}")
    target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
  if(NOT ARG_PLAIN)
    target_precompile_headers(${name} REUSE_FROM weft_precompiled)
  endif()
  if(NOT ARG_APART)
    weft_joined(${name})
  endif()
endfunction()

# weft_vector_code(SOURCES...): what Highway compiles once a target, and so includes itself. No fuzzer looks into it: for
# one such file under sanitizers clang takes more than five minutes.
function(weft_vector_code)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  if(WEFT_FUZZERS)
    set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS -fno-sanitize=all SKIP_PRECOMPILE_HEADERS ON)
  endif()
endfunction()

# weft_test(NAME DEPENDS ... SOURCES ...): one test program. CTest has one entry a program, whose tests share what they
# prepare; SHARDS n makes n entries NAME.1 to NAME.n, each with its share of the tests. An entry computes, and
# holds one of the cores that `./dev test` gives out; one that WAITS, for clocks of devices and programs, holds none.
# SERIAL: it runs with no other beside it, since what it asserts is real time. Those that wait begin first, then the
# longest, by TIMEOUT. SOAK NAME=VALUE: another entry, NAME_soak, which has this variable and draws more by it.
function(weft_test name)
  cmake_parse_arguments(ARG "SERIAL;WAITS" "TIMEOUT;SHARDS;SOAK" "SOURCES;DEPENDS;LABELS;ENVIRONMENT" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE weft_settings ${ARG_DEPENDS} GTest::gtest_main GTest::gmock)
  target_compile_options(${name} PRIVATE ${WEFT_TEST_OPTIONS})
  target_precompile_headers(${name} REUSE_FROM weft_precompiled_tests)
  weft_joined(${name})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 600)
  endif()
  if(ARG_SHARDS)
    foreach(shard RANGE 1 ${ARG_SHARDS})
      math(EXPR index "${shard} - 1")
      weft_test_entry(${name} ${name}.${shard} GTEST_TOTAL_SHARDS=${ARG_SHARDS} GTEST_SHARD_INDEX=${index})
    endforeach()
  else()
    weft_test_entry(${name} ${name})
  endif()
  if(ARG_SOAK)
    set(ARG_LABELS soak)
    set(ARG_TIMEOUT 3600)
    weft_test_entry(${name} ${name}_soak ${ARG_SOAK})
  endif()
endfunction()

# weft_test_entry(PROGRAM ENTRY [NAME=VALUE...]): within weft_test, whose ARG_ it reads.
function(weft_test_entry program entry)
  add_test(NAME ${entry} COMMAND ${program})
  cmake_path(RELATIVE_PATH CMAKE_CURRENT_SOURCE_DIR BASE_DIRECTORY ${CMAKE_SOURCE_DIR}/tests OUTPUT_VARIABLE room)
  string(REGEX REPLACE "/.*" "" room "${room}")
  set_tests_properties(${entry} PROPERTIES TIMEOUT ${ARG_TIMEOUT} COST ${ARG_TIMEOUT} RUN_SERIAL ${ARG_SERIAL}
    LABELS "room-${room};${ARG_LABELS}"
    ENVIRONMENT "GTEST_OUTPUT=xml:${CMAKE_BINARY_DIR}/gtest/${entry}.xml;${ARGN};${ARG_ENVIRONMENT}")
  if(ARG_WAITS)
    set_tests_properties(${entry} PROPERTIES COST 10000)
  else()
    set_tests_properties(${entry} PROPERTIES RESOURCE_GROUPS cores:1)
  endif()
endfunction()

# weft_fuzzer(NAME DEPENDS ... SOURCES ... SEEDS ...): one libFuzzer program, one CTest entry. It goes on from where it
# last ended in this build folder, and from the folders of SEEDS; what breaks it is kept in corpus/NAME-*.
function(weft_fuzzer name)
  cmake_parse_arguments(ARG "" "LABEL" "SOURCES;DEPENDS;SEEDS" ${ARGN})
  if(NOT WEFT_FUZZERS)
    return()
  endif()
  if(NOT ARG_LABEL)
    set(ARG_LABEL fuzz)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_compile_options(${name} PRIVATE -fsanitize=fuzzer)
  target_link_options(${name} PRIVATE -fsanitize=fuzzer)
  target_link_libraries(${name} PRIVATE weft_settings ${ARG_DEPENDS})
  set(corpus ${CMAKE_BINARY_DIR}/corpus/${name})
  file(MAKE_DIRECTORY ${corpus})
  add_test(NAME ${name} COMMAND ${name} -max_total_time=${WEFT_FUZZ_SECONDS} -rss_limit_mb=2048 -timeout=10
    -print_final_stats=1 -artifact_prefix=${corpus}- ${corpus} ${ARG_SEEDS})
  math(EXPR timeout "${WEFT_FUZZ_SECONDS} + 120")
  set_tests_properties(${name} PROPERTIES TIMEOUT ${timeout} LABELS ${ARG_LABEL})
endfunction()
