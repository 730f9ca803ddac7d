# Writes OUTPUT, the definition of built_in_profiles(): the files of the list PROFILES. Run with cmake -P.
cmake_policy(VERSION 3.25)
set(rows "")
foreach(file IN LISTS PROFILES)
  get_filename_component(name ${file} NAME)
  file(READ ${file} content)
  string(APPEND rows "    {\"${name}\", R\"json(${content})json\"},\n")
endforeach()
file(WRITE ${OUTPUT} "#include \"device/meaning/built_in_profiles.hpp\"\n\nnamespace edsc {\nnamespace {\n\nconstexpr BuiltInProfile profiles[] = {\n${rows}};\n\n}  // namespace\n\nstd::span<const BuiltInProfile> built_in_profiles() { return profiles; }\n\n}  // namespace edsc\n")
