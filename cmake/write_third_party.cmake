# cmake -DROWS=file -DVERSION=version -DOUTPUT=folder -P write_third_party.cmake: writes OUTPUT/THIRD-PARTY-NOTICES and
# OUTPUT/edsc.cdx.json from the rows of EdscThirdParty.cmake. Neither has a time or a random number: the same rows give the
# same bytes.
cmake_policy(VERSION 3.25)
file(STRINGS ${ROWS} rows ENCODING UTF-8)
set(line "--------------------------------------------------------------------------------\n")

set(notices "The program edsc ${VERSION} has the MIT License. It uses these libraries. `inside`: the code of the library is part of the
program.

")
set(texts "")
set(licenses "")
set(components "")
set(references "")
foreach(row IN LISTS rows)
  string(REPLACE "|" ";" row "${row}")
  list(GET row 0 name)
  list(GET row 1 version)
  list(GET row 2 license)
  list(GET row 3 purl)
  list(GET row 4 url)
  list(GET row 5 inside)
  list(GET row 6 text_file)
  list(GET row 7 common)
  string(APPEND notices "${name} ${version}\n    license: ${license}\n    url: ${url}\n    inside: ${inside}\n")
  if(EXISTS "${text_file}")
    file(READ ${text_file} text)
  else()
    message(WARNING "${name}: the file with its copyright notices, ${text_file}, is missing")
    set(text "The copyright notices and the license are at ${url}\n")
  endif()
  string(APPEND texts "\n${line}${name} ${version}\n${line}\n${text}")
  string(REPLACE "," ";" common "${common}")
  list(APPEND licenses ${common})

  # A license of SPDX is an `id`, several of them are an `expression`.
  if(license MATCHES " ")
    set(license_json "{ \"expression\": \"${license}\" }")
  else()
    set(license_json "{ \"license\": { \"id\": \"${license}\" } }")
  endif()
  set(reference "pkg:${purl}@${version}")
  list(APPEND components "    {
      \"type\": \"library\",
      \"bom-ref\": \"${reference}\",
      \"name\": \"${name}\",
      \"version\": \"${version}\",
      \"purl\": \"${reference}\",
      \"licenses\": [${license_json}],
      \"externalReferences\": [{ \"type\": \"website\", \"url\": \"${url}\" }],
      \"properties\": [{ \"name\": \"edsc:inside\", \"value\": \"${inside}\" }]
    }")
  list(APPEND references "\"${reference}\"")
endforeach()
list(REMOVE_DUPLICATES licenses)
foreach(name IN LISTS licenses)
  if(EXISTS /usr/share/common-licenses/${name})
    file(READ /usr/share/common-licenses/${name} text)
    string(APPEND texts "\n${line}${name}\n${line}\n${text}")
  endif()
endforeach()
list(JOIN components ",\n" components)
list(JOIN references ",\n        " references)

file(WRITE ${OUTPUT}/THIRD-PARTY-NOTICES "${notices}${texts}")
file(WRITE ${OUTPUT}/edsc.cdx.json "{
  \"bomFormat\": \"CycloneDX\",
  \"specVersion\": \"1.5\",
  \"version\": 1,
  \"metadata\": {
    \"component\": {
      \"type\": \"application\",
      \"bom-ref\": \"edsc@${VERSION}\",
      \"name\": \"edsc\",
      \"version\": \"${VERSION}\",
      \"licenses\": [{ \"license\": { \"id\": \"MIT\" } }]
    }
  },
  \"components\": [
${components}
  ],
  \"dependencies\": [
    {
      \"ref\": \"edsc@${VERSION}\",
      \"dependsOn\": [
        ${references}
      ]
    }
  ]
}
")
