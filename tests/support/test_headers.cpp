// A library needs a file; the headers are in CMakeLists.txt.
