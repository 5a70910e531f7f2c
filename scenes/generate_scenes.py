#!/usr/bin/env python3
"""Writes the shipped scenes beside itself. With --check it writes nothing and fails when a file is
not what it would write."""

import pathlib
import sys

from generate.catalogue import all_files
from generate.looks import looks
from generate.templates import templates
from generate.textures import all_textures


def main():
    folder = pathlib.Path(__file__).resolve().parent
    if sys.argv[1:] not in ([], ["--check"]):
        print("usage: generate_scenes.py [--check]", file=sys.stderr)
        return 2
    stale = 0
    for name, content in sorted((all_files() | looks() | all_textures() | templates()).items()):
        path = folder / name
        if sys.argv[1:] == ["--check"]:
            if not path.is_file() or path.read_bytes() != content:
                print(f"{path} is not what generate_scenes.py writes: run it", file=sys.stderr)
                stale = 1
        else:
            path.parent.mkdir(exist_ok=True)
            path.write_bytes(content)
            print(f"{len(content):8d} bytes  {path}")
    return stale


if __name__ == "__main__":
    sys.exit(main())
