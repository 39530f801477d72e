# Files that become part of the program.
set(edmill_embed_script ${CMAKE_CURRENT_LIST_DIR}/WriteEmbedded.cmake)

# edmill_embed(target file [name [room]]): room::name, of report unless it is given, holds the text
# of the file in the target; the name is that of the file, with its dot as an underscore, unless it
# is given.
function(edmill_embed target file)
  get_filename_component(name ${file} NAME)
  string(REPLACE "." "_" name ${name})
  if(ARGC GREATER 2)
    set(name ${ARGV2})
  endif()
  set(room report)
  if(ARGC GREATER 3)
    set(room ${ARGV3})
  endif()
  set(source ${CMAKE_BINARY_DIR}/embedded/${name}.cpp)
  add_custom_command(OUTPUT ${source} DEPENDS ${file} ${edmill_embed_script}
                     COMMAND ${CMAKE_COMMAND} -DNAME=${name} -DROOM=${room} -DFILE=${file} -DTARGET=${source} -P ${edmill_embed_script}
                     VERBATIM)
  target_sources(${target} PRIVATE ${source})
  set_source_files_properties(${source} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
endfunction()
