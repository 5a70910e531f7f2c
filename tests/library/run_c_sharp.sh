#!/bin/sh
# Compiles a C# program and runs it with the built library.
# usage: run_c_sharp.sh PROGRAM.cs BUILD SCENE
set -e
program=$2/examples_$(basename "$1" .cs).exe
mcs -warnaserror -out:"$program" "$1"
LD_LIBRARY_PATH=$2/library exec mono "$program" "$3"
