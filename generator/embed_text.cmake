# Writes OUTPUT, a source that defines the constant NAME of the namespace edsc as the text of INPUT. Run with cmake -P.
cmake_policy(VERSION 3.25)
file(READ ${INPUT} content)
file(WRITE ${OUTPUT} "#include <string_view>\n\nnamespace edsc {\n\nextern const std::string_view ${NAME};\nconst std::string_view ${NAME} = R\"text(${content})text\";\n\n}  // namespace edsc\n")
