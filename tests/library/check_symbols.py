#!/usr/bin/env python3
"""Fails when the library, shared or an archive, shows other symbols than those of include/torsion/.

usage: check_symbols.py LIBRARY
"""
import re
import subprocess
import sys

# The C functions; the C++ interface, of which nothing is in torsion::engine.
ALLOWED = re.compile(r"^(TORSION_\d+|torsion_\w+|(?:vtable for |typeinfo (?:name )?for )?torsion::(?!engine\b).*)$")


def main():
    archive = sys.argv[1].endswith(".a")
    listed = subprocess.run(["nm", "--extern-only" if archive else "--dynamic", "--defined-only", "--demangle",
                             "--format=posix", sys.argv[1]], check=True, capture_output=True, text=True).stdout
    # Of an archive not what is weak: templates of the standard library, which any program has as well.
    lines = [line for line in listed.splitlines() if re.search(r" [A-Za-z] [0-9a-f ]*$", line)
             and not (archive and re.search(r" [WwVvu] [0-9a-f ]*$", line))]
    names = [re.sub(r"(@@TORSION_\d+)? [A-Za-z] [0-9a-f ]*$", "", line) for line in lines]
    others = [name for name in names if not ALLOWED.match(name)]
    print("\n".join(others) if others else f"{len(names)} symbols, all of the interface")
    return 1 if others or not names else 0


if __name__ == "__main__":
    sys.exit(main())
