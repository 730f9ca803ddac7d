# Writes OUTPUT: TEMPLATES and REPORT_TEMPLATES (lists of *.mustache files) as string literals. Run with cmake -P.
set(text "#include \"backend/render.hpp\"\n\nnamespace edsc {\n")

function(embed function)
  set(code "\nconst std::vector<Template>& ${function}() {\n  static const std::vector<Template> templates = {\n")
  foreach(file IN LISTS ARGN)
    get_filename_component(name ${file} NAME)
    string(REGEX REPLACE "\\.mustache$" "" name ${name})
    file(READ ${file} content)
    string(APPEND code "      {\"${name}\", R\"mustache(${content})mustache\"},\n")
  endforeach()
  string(APPEND code "  };\n  return templates;\n}\n")
  set(text "${text}${code}" PARENT_SCOPE)
endfunction()

embed(built_in_templates ${TEMPLATES})
embed(report_templates ${REPORT_TEMPLATES})
file(WRITE ${OUTPUT} "${text}\n}  // namespace edsc\n")
