# How a target of ours is made: warnings are errors for our code and only ours, and only where ossa is
# what is built, not a part of another project with a compiler that we do not know. Not of GCC with
# sanitizers, whose checks make it see uninitialised values where there are none.
add_library(ossa_warnings INTERFACE)
target_compile_options(ossa_warnings INTERFACE -Wall -Wextra -Wconversion)
if(PROJECT_IS_TOP_LEVEL AND (NOT OSSA_SANITIZE OR CMAKE_CXX_COMPILER_ID MATCHES "Clang"))
  target_compile_options(ossa_warnings INTERFACE -Werror)
endif()
# Of several files compiled as one GCC takes a class of a file's own for one that others see.
if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(ossa_warnings INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wno-subobject-linkage>)
endif()

# What hardens our code and only ours against what a hostile file makes of a mistake: stacks whose
# overrun is seen, checked library calls and containers, tables of addresses that are closed after
# loading. Tests need none of it, and sanitizers see more than any of it.
# docs/benchmarks/robustness.md says what they cost.
set(OSSA_HARDEN ON CACHE STRING "ON, OFF or a list: stack, fortify, assertions, relro")
set(kinds_of_hardening stack fortify assertions relro)
string(TOUPPER "${OSSA_HARDEN}" harden)
if(OSSA_SANITIZE)
  set(hardened relro)
elseif(harden MATCHES "^(ON|TRUE|YES|Y|1)$")
  set(hardened ${kinds_of_hardening})
elseif(harden MATCHES "^(OFF|FALSE|NO|N|0|)$")
  set(hardened)
else()
  set(hardened ${OSSA_HARDEN})
  foreach(kind IN LISTS hardened)  # a word mistyped would harden nothing, in silence
    if(NOT kind IN_LIST kinds_of_hardening)
      message(FATAL_ERROR "OSSA_HARDEN: expected ON, OFF or a list of ${kinds_of_hardening}, found ${kind}")
    endif()
  endforeach()
endif()
add_library(ossa_hardening INTERFACE)
if("relro" IN_LIST hardened)
  target_link_options(ossa_hardening INTERFACE -Wl,-z,relro,-z,now)
endif()
if("stack" IN_LIST hardened)
  target_compile_options(ossa_hardening INTERFACE -fstack-protector-strong)
endif()
if("assertions" IN_LIST hardened)
  target_compile_definitions(ossa_hardening INTERFACE _GLIBCXX_ASSERTIONS)
endif()
if("fortify" IN_LIST hardened)  # by an optimiser, which sees the sizes
  target_compile_options(ossa_hardening INTERFACE
    $<$<NOT:$<CONFIG:Debug>>:-U_FORTIFY_SOURCE> $<$<NOT:$<CONFIG:Debug>>:-D_FORTIFY_SOURCE=2>)
endif()

# On 64-bit ARM the same bytes as on x86-64: no product is fused with the sum that it goes into, Eigen sums in
# the same order, and a char has a sign.
add_library(ossa_arithmetic INTERFACE)
# On any processor the same bytes, too: Eigen splits the sums of large products by the sizes of the caches,
# which it would ask the processor for. Bytes; its own defaults for x86-64.
target_compile_definitions(ossa_arithmetic INTERFACE EIGEN_NO_CPUID EIGEN_DEFAULT_L1_CACHE_SIZE=32768
  EIGEN_DEFAULT_L2_CACHE_SIZE=262144 EIGEN_DEFAULT_L3_CACHE_SIZE=2097152)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64)$")
  find_path(SIMDE_INCLUDE simde/x86/sse2.h REQUIRED)  # libsimde-dev
  target_link_libraries(ossa_arithmetic INTERFACE Eigen3::Eigen)
  target_include_directories(ossa_arithmetic SYSTEM INTERFACE ${PROJECT_SOURCE_DIR}/cmake/arm64)
  target_compile_options(ossa_arithmetic INTERFACE -ffp-contract=off -fsigned-char
    "$<$<COMPILE_LANGUAGE:CXX>:SHELL:-include ${PROJECT_SOURCE_DIR}/cmake/arm64/eigen_as_sse2.h>")
endif()

# ossa_alone(SOURCE...): names of these files' own are those of a neighbour's own, too, so that the two are
# never compiled as one source (CMAKE_UNITY_BUILD: tests always, libraries in tests/run's second build).
function(ossa_alone)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# ossa_common(TARGET), of what people run; ossa_plain(TARGET), of what only tries that.
function(ossa_common target)
  ossa_plain(${target})
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:ossa_hardening>)
endfunction()

function(ossa_plain target)
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:ossa_warnings> $<BUILD_INTERFACE:ossa_arithmetic>)
  target_include_directories(${target} PRIVATE ${ossa_SOURCE_DIR})
  if(OSSA_SANITIZE)  # sources by their place in the tree, so that a compiler cache serves any folder
    target_compile_options(${target} PRIVATE -fsanitize=${OSSA_SANITIZE} -fno-omit-frame-pointer
                           -fno-sanitize-recover=all -ffile-prefix-map=${ossa_SOURCE_DIR}=.)
    target_link_options(${target} PRIVATE -fsanitize=${OSSA_SANITIZE})
  endif()
endfunction()

# ossa_library(NAME [COMPONENT tools] SOURCES ... HEADERS ... [PUBLIC targets...] [PRIVATE targets...])
# makes ossa_NAME, known to users as ossa::NAME; HEADERS are the public ones and are installed. A library
# without HEADERS serves the command alone: applications cannot link an installed one. COMPONENT says which
# package it is of: `tools`, which brings Embree and MPI, or `runtime`.
function(ossa_library name)
  cmake_parse_arguments(ARG "" "COMPONENT" "SOURCES;HEADERS;PUBLIC;PRIVATE" ${ARGN})
  if(NOT ARG_COMPONENT)
    set(ARG_COMPONENT runtime)
  endif()
  set(target ossa_${name})
  add_library(${target} ${ARG_SOURCES})
  add_library(ossa::${name} ALIAS ${target})
  ossa_common(${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} VERSION ${PROJECT_VERSION}
                        SOVERSION ${PROJECT_VERSION_MAJOR})
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${ossa_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/ossa>)
  if(NOT BUILD_SHARED_LIBS)  # compiled as for shared ones, so that a compiler cache serves both
    target_compile_definitions(${target} PRIVATE ${target}_EXPORTS)
  endif()
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_link_libraries(${target} PUBLIC Eigen3::Eigen ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  if(ARG_HEADERS)
    install(TARGETS ${target} EXPORT ossaTargets ARCHIVE COMPONENT dev
            LIBRARY COMPONENT ${ARG_COMPONENT} NAMELINK_COMPONENT dev)
  elseif(BUILD_SHARED_LIBS)
    install(TARGETS ${target} LIBRARY COMPONENT ${ARG_COMPONENT} NAMELINK_SKIP)
  endif()
  foreach(header IN LISTS ARG_HEADERS)
    cmake_path(RELATIVE_PATH CMAKE_CURRENT_SOURCE_DIR BASE_DIRECTORY ${ossa_SOURCE_DIR}
               OUTPUT_VARIABLE room)
    cmake_path(GET header PARENT_PATH folder)
    install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/ossa/${room}/${folder} COMPONENT dev)
  endforeach()
endfunction()

# ossa_test(NAME SOURCES ... LIBS ...): one GoogleTest program whose tests ctest lists one by one.
# LABELS: `slow` for tests of many seconds.
function(ossa_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBS;LABELS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  ossa_plain(${name})
  # What a test spends its time on is in the libraries: a better optimiser only costs building time.
  # With -O1 GCC 12 takes copies of an empty std::optional for reads of what it does not hold.
  target_compile_options(${name} PRIVATE
    $<$<CONFIG:Release>:-O1> $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_link_libraries(${name} PRIVATE ${ARG_LIBS} ossa_test_places GTest::gtest GTest::gtest_main)
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST
                       PROPERTIES TIMEOUT 300 LABELS "${ARG_LABELS}")
endfunction()
