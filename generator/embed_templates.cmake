# Writes OUTPUT: TEMPLATES and REPORT_TEMPLATES (lists of files, most of them *.mustache) as string literals, and the files of TARGETS, a
# list of folders, each by the name of its folder. Those that are in OPTIONAL need the member of the view of their name. Run with cmake -P.
cmake_policy(VERSION 3.25)
set(text "#include \"backend/render.hpp\"\n\n#include <map>\n\nnamespace edsc {\n")

# rows(RESULT FILE...): the rows of a table of templates.
function(rows result)
  set(code "")
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
  set(${result} "${code}" PARENT_SCOPE)
endfunction()

# embed(FUNCTION FILE...)
function(embed function)
  rows(code ${ARGN})
  set(text "${text}\nconst std::vector<Template>& ${function}() {\n  static const std::vector<Template> templates = {\n${code}  };\n  return templates;\n}\n" PARENT_SCOPE)
endfunction()

embed(built_in_templates ${TEMPLATES})
embed(report_templates ${REPORT_TEMPLATES})

string(APPEND text "\nconst std::vector<Template>& target_templates(std::string_view target) {\n  static const std::map<std::string_view, std::vector<Template>> templates = {\n      {\"cpp\", built_in_templates()},\n")
foreach(folder IN LISTS TARGETS)
  get_filename_component(name ${folder} NAME)
  file(GLOB files ${folder}/*.mustache)
  rows(code ${files})
  string(APPEND text "      {\"${name}\", {\n${code}      }},\n")
endforeach()
string(APPEND text "  };\n  return templates.at(target);\n}\n")
file(WRITE ${OUTPUT} "${text}\n}  // namespace edsc\n")
