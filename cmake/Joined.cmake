# SPDX-License-Identifier: Apache-2.0
# A build that is made whole compiles eight files of a target at a time: a name of an unnamed namespace stands once in
# a target. The preset dev compiles each by itself, and so shows what it forgot to include. CMake's own unity build
# includes files by whole paths; here they are included by their names from the root, so that to the compiler cache a
# file of one clone is the file of another.
option(WEFT_JOINED "Compile eight files of a target at a time" OFF)

# weft_joined(TARGET): once all is known of its files. One with options of its own, or with SKIP_UNITY_BUILD_INCLUSION,
# stays alone, as in CMake.
function(weft_joined target)
  if(WEFT_JOINED)
    cmake_language(EVAL CODE "cmake_language(DEFER CALL weft_join ${target})")
  endif()
endfunction()

function(weft_join target)
  get_target_property(sources ${target} SOURCES)
  set(alone "")
  set(together "")
  foreach(source IN LISTS sources)
    get_source_file_property(skipped ${source} SKIP_UNITY_BUILD_INCLUSION)
    get_source_file_property(options ${source} COMPILE_OPTIONS)
    if(skipped OR options OR IS_ABSOLUTE ${source} OR NOT source MATCHES "[.]cpp$")
      list(APPEND alone ${source})
    else()
      list(APPEND together ${source})
    endif()
  endforeach()
  cmake_path(RELATIVE_PATH CMAKE_CURRENT_SOURCE_DIR BASE_DIRECTORY ${CMAKE_SOURCE_DIR} OUTPUT_VARIABLE folder)
  list(LENGTH together left)
  set(number 0)
  while(left GREATER 1)
    list(SUBLIST together 0 8 eight)
    list(REMOVE_ITEM together ${eight})
    list(LENGTH together left)
    list(TRANSFORM eight REPLACE "(.+)" "#include \"${folder}/\\1\"\n")
    list(JOIN eight "" text)
    set(unit ${CMAKE_CURRENT_BINARY_DIR}/joined/${target}_${number}.cpp)
    file(CONFIGURE OUTPUT ${unit} CONTENT "${text}" @ONLY)
    list(APPEND alone ${unit})
    math(EXPR number "${number} + 1")
  endwhile()
  set_property(TARGET ${target} PROPERTY SOURCES ${alone} ${together})
endfunction()
