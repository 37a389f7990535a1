# One static library per stage of the pipeline. What a stage links is what it may include, so
# the layering of compiler/README.md is what the linker sees too.
#
#   lobe_stage(NAME SOURCES a.cpp b.cpp [LINKS stage-or-library ...] [PRIVATE_LINKS ...])

find_package(fmt REQUIRED)

function(lobe_warnings target)
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
    # GCC 12 warns of overlapping copies inside std::string's own operator+ (GCC bug 105651).
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
  set_target_properties(${target} PROPERTIES COMPILE_WARNING_AS_ERROR ${LOBE_STRICT})
endfunction()

function(lobe_stage name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINKS;PRIVATE_LINKS" ${ARGN})
  add_library(lobe_${name} STATIC ${ARG_SOURCES})
  add_library(lobe::${name} ALIAS lobe_${name})
  target_include_directories(lobe_${name} PUBLIC ${PROJECT_SOURCE_DIR}/compiler)
  target_compile_features(lobe_${name} PUBLIC cxx_std_20)
  # Results must not depend on what the compiler fuses; see docs/numerics.md.
  target_compile_options(lobe_${name} PRIVATE -ffp-contract=off)
  target_link_libraries(lobe_${name} PUBLIC ${ARG_LINKS} PRIVATE fmt::fmt ${ARG_PRIVATE_LINKS})
  lobe_warnings(lobe_${name})
endfunction()
