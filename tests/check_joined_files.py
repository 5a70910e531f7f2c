#!/usr/bin/env python3
"""Fails when source files that a unity build may compile as one use a name at file scope for two things. Which files it
joins depends on the preset and on how many there are, so that the compiler finds such names on some machines only.

Looked at are the files of each top folder but tests/: types and constants at file scope that have the name of another
one, and constants of functions that hide one of another file.

usage: check_joined_files.py [--self-test]
"""
import re
import sys

from check_type_names import TYPE, places_of, texts_of

CONSTANT = re.compile(r"^(?:inline )?constexpr [^=;()]*?\b(k[A-Z]\w*)\b", re.MULTILINE)
LOCAL = re.compile(r"^ +(?:static )?constexpr [^=;()]*?\b(k[A-Z]\w*)\b", re.MULTILINE)


def clashes(texts):
    """Of {path: text}, a list of 'name: path, path' for what would clash if the sources were compiled as one."""
    sources = {path: text for path, text in texts.items() if path.endswith(".cpp")}
    found = set()
    for pattern in (TYPE, CONSTANT):
        everywhere = places_of(pattern, texts)
        found |= {(name, tuple(sorted(everywhere[name]))) for name in places_of(pattern, sources)
                  if len(everywhere[name]) > 1}
    of_functions = places_of(LOCAL, sources)
    for name, of_files in places_of(CONSTANT, sources).items():
        if of_functions.get(name, set()) - of_files:
            found.add((name, tuple(sorted(of_files | of_functions[name]))))
    return [f"{name}: {', '.join(paths)}" for name, paths in sorted(found)]


def self_test():
    cases = [
        ({"a.cpp": "struct A {\n", "b.cpp": "struct B {\n"}, 0),
        ({"a.cpp": "struct A {\n", "b.cpp": "struct A {\n"}, 1),
        ({"a.cpp": "struct A {\n", "b.hpp": "struct A {\n"}, 1),
        ({"a.hpp": "struct A {\n", "b.hpp": "struct A {\n"}, 0),
        ({"a.cpp": "constexpr double kA = 1.0;\n", "b.cpp": "constexpr int kA = 1;\n"}, 1),
        ({"a.cpp": "constexpr double kA = 1.0;\n", "b.cpp": "  constexpr int kA = 1;\n"}, 1),
        ({"a.cpp": "  constexpr double kA = 1.0;\n", "b.cpp": "  constexpr int kA = 1;\n"}, 0),
        ({"a.cpp": "constexpr double kA = kB;\n", "b.cpp": "constexpr double kB = 1.0;\n"}, 0),
    ]
    wrong = [case for case in cases if len(clashes(case[0])) != case[1]]
    for texts, expected in wrong:
        print(f"self-test: {texts}: expected {expected}, got {clashes(texts)}")
    return 1 if wrong else 0


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    folders = {}
    for path, text in texts_of("*.hpp", "*.cpp").items():
        if not path.startswith("tests/"):
            folders.setdefault(path.split("/")[0], {})[path] = text
    found = [clash for texts in folders.values() for clash in clashes(texts)]
    print("\n".join(found) if found else f"{sum(map(len, folders.values()))} files, no two clash when joined")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
