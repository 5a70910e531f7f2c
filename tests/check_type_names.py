#!/usr/bin/env python3
"""Fails when two headers of one namespace, torsion or torsion::engine, define types of one name: their inline functions
and the containers of them share names, and the linker takes either (C++ standard, [basic.def.odr]).

usage: check_type_names.py [--self-test]
"""
import pathlib
import re
import subprocess
import sys

# At the beginning of a line: what is nested or local has a scope of its own.
TYPE = re.compile(r"^(?:struct|class|union|enum(?: class| struct)?) (?:TORSION_API )?(\w+)\b(?!::)[^;()]*\{", re.MULTILINE)


def places_of(pattern, texts):
    """Of {path: text}, {name: the set of the paths where the pattern finds it}."""
    places = {}
    for path, text in texts.items():
        for name in pattern.findall(text):
            places.setdefault(name, set()).add(path)  # once, however many specializations
    return places


def texts_of(*patterns):
    """{path: text} of the project's files of those names."""
    root = pathlib.Path(__file__).resolve().parent.parent
    listed = subprocess.run(["git", "ls-files", "--", *patterns], cwd=root, check=True,
                            capture_output=True, text=True)
    return {path: (root / path).read_text(encoding="utf-8")
            for path in listed.stdout.splitlines() if (root / path).is_file()}


def doubled_types(texts):
    """Of {path: text}, a list of 'name: path, path' for the types defined in several."""
    return [f"{name}: {', '.join(sorted(paths))}"
            for name, paths in sorted(places_of(TYPE, texts).items()) if len(paths) > 1]


def self_test():
    cases = [
        ({"a.hpp": "struct A {\n", "b.hpp": "struct B {\n"}, 0),
        ({"a.hpp": "struct A {\n", "b.hpp": "class A {\n"}, 1),
        ({"a.hpp": "struct A {};\n", "b.hpp": "struct A;\n"}, 0),
        ({"a.hpp": "enum class A : std::uint8_t {\n", "b.hpp": "class A final : public B {\n"}, 1),
        ({"a.hpp": "struct A<float> {\n};\nstruct A<int> {\n};\n"}, 0),
        ({"a.hpp": "struct A {\n  struct Row {\n", "b.hpp": "struct B {\n  struct Row {\n"}, 0),
    ]
    wrong = [case for case in cases if len(doubled_types(case[0])) != case[1]]
    for texts, expected in wrong:
        print(f"self-test: {texts}: expected {expected}, got {doubled_types(texts)}")
    return 1 if wrong else 0


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    texts = texts_of("*.hpp")
    of_engine = {path: text for path, text in texts.items() if "namespace torsion::engine" in text}
    of_interface = {path: text for path, text in texts.items() if path not in of_engine}
    found = doubled_types(of_engine) + doubled_types(of_interface)
    print("\n".join(found) if found else f"{len(texts)} headers, no type defined twice")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
