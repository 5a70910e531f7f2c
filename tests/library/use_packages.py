"""Makes the Debian packages, unpacks them into a folder and uses what they bring from there.

usage: use_packages.py BUILD SCENE CONSUMER.cpp
"""

import os
import pathlib
import shutil
import subprocess
import sys

PACKAGES = {"libtorsion1", "libtorsion-dev", "python3-torsion", "torsion"}


def run(*command, **environment):
    """What a command prints; it must end well."""
    done = subprocess.run(
        list(map(str, command)), env={**os.environ, **environment}, capture_output=True, text=True
    )
    if done.returncode != 0:
        sys.exit(f"{command}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def field(package, name):
    return run("dpkg-deb", "-f", package, name).strip()


def files_of(package):
    lines = [line.split() for line in run("dpkg-deb", "-c", package).splitlines()]
    return [line[5] for line in lines if not line[0].startswith("d")]


def check_dependencies(packages):
    """Each is one of these packages or one that this machine has; else a name is wrong or a library is not declared."""
    for package in packages.values():
        for dependency in field(package, "Depends").split(","):
            names = [name.split()[0] for name in dependency.split("|")]
            known = [name for name in names if name in packages or installed(name)]
            assert known, f"{package.name} depends on {dependency}, which nobody has"


def installed(name):
    done = subprocess.run(["dpkg-query", "-W", "-f=${db:Status-Status}", name], capture_output=True, text=True)
    return done.returncode == 0 and done.stdout == "installed"


def check_files(packages):
    owners = {}
    for name, package in packages.items():
        for file in files_of(package):
            assert file not in owners, f"{file} is in {owners[file]} and in {name}"
            owners[file] = name
            assert file.startswith("./usr/"), f"{name} writes {file}"


def check_binaries(root, build):
    """None looks for libraries in the build folder, as they do where they were built."""
    for file in root.rglob("*"):
        if file.is_symlink() or not file.is_file() or file.open("rb").read(4) != b"\x7fELF":
            continue
        assert str(build) not in run("readelf", "-d", file), f"{file} looks for libraries in {build}"


def main():
    build, scene, consumer = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
    place = build / "packages_test"
    shutil.rmtree(place, ignore_errors=True)
    place.mkdir()
    output = f"CPACK_OUTPUT_FILE_PREFIX={place}"
    run("cpack", "-G", "DEB", "--config", build / "CPackConfig.cmake", "-D", output, "-B", place)
    packages = {field(package, "Package"): package for package in sorted(place.glob("*.deb"))}
    assert set(packages) == PACKAGES, f"packages made: {sorted(packages)}"
    check_dependencies(packages)
    check_files(packages)
    root = place / "root"
    for package in packages.values():
        run("dpkg-deb", "-x", package, root)
    check_binaries(root, build)

    library = next(root.rglob("libtorsion.so.1")).parent
    paths = {"LD_LIBRARY_PATH": str(library), "PYTHONPATH": str(root / "usr/lib/python3/dist-packages")}
    program = root / "usr/bin/torsion"
    assert run(program, "--version").strip() == field(packages["torsion"], "Version")
    shipped = root / "usr/share/torsion/scenes" / scene.name
    assert "largest force" in run(program, "simulate", shipped, "--seconds", "0.5", **paths)
    build_it = f"torsion.Simulation(torsion.build(torsion.load({str(shipped)!r})))"
    script = f"import torsion; {build_it}; print(torsion.__file__)"
    assert str(root) in run("/usr/bin/python3", "-c", script, **paths)
    flags = run(
        "pkg-config", "--define-prefix", "--cflags", "--libs", "torsion", PKG_CONFIG_PATH=str(library / "pkgconfig")
    ).split()
    run("c++", "-std=c++20", "-Wall", "-Wextra", "-Werror", consumer, *flags, "-o", place / "consumer")
    run(place / "consumer", shipped, **paths)


main()
