# Files become data of the program, so that it needs none at run time.
#
#   lobe_embed(TARGET FUNCTION BASE FILE ...)
#
# gives TARGET a source that defines
#
#   std::span<const lobe::Embedded> lobe::FUNCTION();   // base/embedded.h
#
# with one entry per file, named relative to BASE, in the order given. Rebuilt when a file changes.

function(lobe_embed target function base)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/${function}.cpp)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -D FUNCTION=${function} -D BASE=${base} -D OUTPUT=${output}
            "-DFILES=${ARGN}" -P ${PROJECT_SOURCE_DIR}/cmake/embed_script.cmake
    DEPENDS ${ARGN} ${PROJECT_SOURCE_DIR}/cmake/embed_script.cmake
    VERBATIM)
  target_sources(${target} PRIVATE ${output})
endfunction()
