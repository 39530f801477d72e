# Files that become part of the program.
set(edmill_embed_script ${CMAKE_CURRENT_LIST_DIR}/WriteEmbedded.cmake)

# edmill_embed(sources name file): report::name holds the text of the file; its source is added to the list `sources`.
function(edmill_embed sources name file)
  set(source ${CMAKE_BINARY_DIR}/embedded/${name}.cpp)
  add_custom_command(OUTPUT ${source} DEPENDS ${file} ${edmill_embed_script}
                     COMMAND ${CMAKE_COMMAND} -DNAME=${name} -DFILE=${file} -DTARGET=${source} -P ${edmill_embed_script}
                     VERBATIM)
  set(${sources} ${${sources}} ${source} PARENT_SCOPE)
endfunction()
