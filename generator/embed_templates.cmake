# Writes OUTPUT: TEMPLATES and REPORT_TEMPLATES (lists of files, most of them *.mustache) as string literals. Those that are in OPTIONAL need
# the member of the view of their name. Run with cmake -P.
cmake_policy(VERSION 3.25)
set(text "#include \"backend/render.hpp\"\n\nnamespace edsc {\n")

function(embed function)
  set(code "\nconst std::vector<Template>& ${function}() {\n  static const std::vector<Template> templates = {\n")
  foreach(file IN LISTS ARGN)
    get_filename_component(name ${file} NAME)
    string(REGEX REPLACE "\\.mustache$" "" name ${name})
    file(READ ${file} content)
    set(needed "")
    if(name IN_LIST OPTIONAL)
      string(REGEX REPLACE "\\.[^.]*$" "" needed ${name})
    endif()
    string(APPEND code "      {\"${name}\", R\"mustache(${content})mustache\", \"${needed}\"},\n")
  endforeach()
  string(APPEND code "  };\n  return templates;\n}\n")
  set(text "${text}${code}" PARENT_SCOPE)
endfunction()

embed(built_in_templates ${TEMPLATES})
embed(report_templates ${REPORT_TEMPLATES})
file(WRITE ${OUTPUT} "${text}\n}  // namespace edsc\n")
