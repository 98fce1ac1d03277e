# Joins what Verilator wrote into FOLDER into FOLDER/all.cpp; the names of its files are not known beforehand.
file(GLOB files ${FOLDER}/*.cpp)
list(REMOVE_ITEM files ${FOLDER}/all.cpp)
list(SORT files)
set(text "")
foreach(file ${files})
  string(APPEND text "#include \"${file}\"\n")
endforeach()
file(WRITE ${FOLDER}/all.cpp "${text}")
