# Writes OUTPUT/uplot.js and OUTPUT/uplot.css: uPlot of the version in the lock file of PACKAGE, which NPM installs in
# OUTPUT. Without npm or a network both are empty: the page of edsc monitor --web then has no plots. Run with cmake -P.
cmake_policy(VERSION 3.25)
file(MAKE_DIRECTORY ${OUTPUT})
set(problem "npm is not installed")
if(NPM)
  file(COPY ${PACKAGE}/package.json ${PACKAGE}/package-lock.json DESTINATION ${OUTPUT})
  execute_process(
    COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --fetch-retries=1
    WORKING_DIRECTORY ${OUTPUT}
    TIMEOUT 120
    RESULT_VARIABLE result
    OUTPUT_VARIABLE text
    ERROR_VARIABLE text)
  set(problem "")
  if(NOT result EQUAL 0)
    set(problem "npm cannot install uPlot:\n${text}")
  endif()
endif()

if(problem)
  message("${problem}\nedsc monitor --web will not have plots. To try again, remove ${OUTPUT} and build.")
  file(WRITE ${OUTPUT}/uplot.js "")
  file(WRITE ${OUTPUT}/uplot.css "")
else()
  configure_file(${OUTPUT}/node_modules/uplot/dist/uPlot.iife.min.js ${OUTPUT}/uplot.js COPYONLY)
  configure_file(${OUTPUT}/node_modules/uplot/dist/uPlot.min.css ${OUTPUT}/uplot.css COPYONLY)
endif()
