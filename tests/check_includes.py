#!/usr/bin/env python3
"""Fails when a file includes what its folder may not: docs/architecture.md says which arrows there are.

usage: check_includes.py [--self-test]
"""
import pathlib
import re
import subprocess
import sys

# Folder -> folders of the project that it may include besides itself.
ALLOWED = {
    "ecs": set(),
    "systems": {"ecs"},
    "scenes": {"ecs"},
    "device": {"ecs"},
    "render": {"ecs", "shaders"},
    "shaders": set(),
    "include": set(),
    "library": {"ecs", "systems", "scenes", "device", "include"},
    "python": {"include"},
    "examples": set(),  # programs of users: <torsion/...>, as installed
    "app": {"ecs", "systems", "scenes", "device", "render"},
    "tests": {"ecs", "systems", "scenes", "device", "render", "shaders", "app", "include"},
}
# Room of systems/ -> rooms that it may include besides itself, from the ground up: no arrow leads back.
# What lies in systems/ itself (the step, and the list of laws) is on top of them all.
ROOMS = {
    "math": set(),
    "geometry": {"math"},
    "half_space": {"math"},
    "contact": {"math", "geometry", "half_space"},
    "paper": {"math", "contact"},
    "mdr": {"math", "geometry", "half_space", "contact"},
    "patch": {"math", "half_space", "contact"},
    "winkler": {"math", "contact"},
    "body": {"math", "half_space", "contact"},
    "model": {"math", "geometry", "half_space", "contact", "body"},
    "hold": {"math", "contact"},
    "surface": {"math", "geometry", "half_space", "contact", "mdr", "body"},
}
# Libraries that only one folder may touch: an include's beginning -> that folder (tests may, too).
OWNED_LIBRARIES = {
    "vulkan/": "render",
    "GLFW/": "render",
    "tiny_gltf": "scenes",
    "libusb": "device",
    "CLI/": "app",
    "ceres/": "app",
    "hdf5": "app",
}
# What a part of a folder may include besides: the report and the window show the references of the tests.
ALLOWED_BESIDES = {"app/report/": "tests/reference/", "app/view/exact_curves": "tests/reference/exact/"}
SUFFIXES = {".cpp", ".hpp", ".h", ".comp", ".vert", ".frag", ".glsl"}
INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]')


def room_of(path):
    """The room of systems/ that a file lies in: None outside of systems/, "" in systems/ itself."""
    parts = pathlib.PurePosixPath(path).parts
    if parts[0] != "systems":
        return None
    return parts[1] if len(parts) > 2 else ""


def room_problem(path, target):
    """What is wrong with an arrow between two rooms of systems/, or None."""
    here, there = room_of(path), room_of(target)
    if not here or there is None or here == there:
        return None
    if here not in ROOMS:
        return f"room systems/{here}/ has no rule in tests/check_includes.py"
    if there not in ROOMS[here]:
        return f"systems/{here}/ may not include {target}"
    return None


def problems_of(path, text):
    """The forbidden includes of one file: a list of 'path:line: what'."""
    folder = pathlib.PurePosixPath(path).parts[0]
    if folder not in ALLOWED:
        return [f"{path}:1: folder {folder}/ has no rule in tests/check_includes.py"]
    found = []
    for number, line in enumerate(text.splitlines(), start=1):
        match = INCLUDE.match(line)
        if not match:
            continue
        quote, target = match.groups()
        place = f"{path}:{number}: "
        for library, owner in OWNED_LIBRARIES.items():
            if target.startswith(library) and folder not in (owner, "tests"):
                found.append(f"{place}only {owner}/ may include <{target}>")
        if any(path.startswith(part) and target.startswith(besides)
               for part, besides in ALLOWED_BESIDES.items()):
            continue
        first = pathlib.PurePosixPath(target).parts[0]
        problem = room_problem(path, target)
        if problem:
            found.append(place + problem)
        if first in ALLOWED and first != folder and first not in ALLOWED[folder]:
            found.append(f"{place}{folder}/ may not include {first}/ ({target})")
        elif path.startswith(ALONE):
            continue
        elif quote == '"' and "/" not in target and folder != "shaders" and not target.endswith(".glsl"):
            # Headers made by the build are the exception, and they have a folder, too.
            found.append(f'{place}write "folder/file.hpp", not "{target}"')
        elif ".." in pathlib.PurePosixPath(target).parts:
            found.append(f'{place}write "folder/file.hpp", not "{target}"')
    return found


# Programs that a person copies out of here and compiles alone, and what stands in for their makers' headers.
ALONE = ("examples/gateway/", "tests/gateway_stubs/")


def self_test():
    cases = [
        ("ecs/a.hpp", '#include "ecs/b.hpp"', 0),
        ("ecs/a.hpp", "#include <vector>", 0),
        ("ecs/a.hpp", '#include "systems/step.hpp"', 1),
        ("systems/a.cpp", '#include "ecs/world.hpp"', 0),
        ("systems/a.cpp", '#include "render/frame.hpp"', 1),
        ("systems/a.cpp", "  #  include <vulkan/vulkan.hpp>", 1),
        ("scenes/a.cpp", "#include <tiny_gltf.h>", 0),
        ("app/a.cpp", "#include <tiny_gltf.h>", 1),
        ("app/a.cpp", '#include "systems/step.hpp"\n#include "render/frame.hpp"', 0),
        ("systems/contact/a.cpp", '#include "systems/math/a.hpp"\n#include "systems/contact/support/a.hpp"', 0),
        ("systems/contact/a.cpp", '#include "systems/patch/a.hpp"\n#include "systems/step.hpp"', 2),
        ("systems/patch/a.cpp", '#include "systems/mdr/a.hpp"', 1),
        ("systems/attic/a.cpp", '#include "systems/math/a.hpp"', 1),
        ("systems/step.cpp", '#include "systems/patch/a.hpp"', 0),
        ("tests/systems/a.cpp", '#include "systems/patch/a.hpp"', 0),
        ("render/a.cpp", '#include "systems/step.hpp"\n#include "app/run.hpp"', 2),
        ("render/a.cpp", '#include "../ecs/world.hpp"', 1),
        ("device/a.cpp", '#include "device.hpp"', 1),
        ("tests/app/a_test.cpp", '#include "app/run.hpp"', 0),
        ("app/a.cpp", '#include "tests/support/image_compare.hpp"', 1),
        ("app/report/a.cpp", '#include "tests/reference/exact/a.hpp"', 0),
        ("app/a.cpp", '#include "tests/reference/exact/a.hpp"', 1),
        ("library/a.cpp", '#include "systems/step.hpp"\n#include "torsion/torsion.hpp"', 0),
        ("library/a.cpp", '#include "render/frame.hpp"\n#include "app/run.hpp"', 2),
        ("include/torsion/a.hpp", '#include "torsion/types.hpp"', 0),
        ("include/torsion/a.hpp", '#include "ecs/components.hpp"', 1),
        ("examples/gateway/a.cpp", '#include "b.h"', 0),
        ("examples/gateway/a.cpp", '#include "ecs/world.hpp"', 1),
        ("tools/a.cpp", "", 1),
        ("ecs/a.hpp", '// #include "systems/step.hpp"', 0),
    ]
    wrong = [case for case in cases if len(problems_of(case[0], case[1])) != case[2]]
    for path, text, expected in wrong:
        print(f"self-test: {path}: {text!r}: expected {expected}, got {problems_of(path, text)}")
    return 1 if wrong else 0


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    root = pathlib.Path(__file__).resolve().parent.parent
    listed = subprocess.run(["git", "ls-files"], cwd=root, check=True, capture_output=True, text=True)
    files = [line for line in listed.stdout.splitlines() if pathlib.PurePosixPath(line).suffix in SUFFIXES]
    found = []
    for file in files:
        if (root / file).is_file():
            found += problems_of(file, (root / file).read_text(encoding="utf-8"))
    print("\n".join(found) if found else f"{len(files)} files, no forbidden include")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
