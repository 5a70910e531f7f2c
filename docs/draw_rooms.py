#!/usr/bin/env python3
"""Draws docs/rooms.svg: the rooms of systems/, from the includes of their files.

usage: draw_rooms.py [--check]   --check: fails when the picture is not that of the files
"""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PICTURE = ROOT / "docs" / "rooms.svg"
PURPOSE = {
    "step": "the list of systems, the laws, the clock",
    "model": "load time: tables, choice, cache, finite elements",
    "hold": "a held tool",
    "surface": "what is drawn",
    "paper": "contact model",
    "mdr": "contact model",
    "patch": "contact model",
    "winkler": "contact model",
    "body": "skeleton, compliance",
    "contact": "poses, points, regions, grids, wrenches; what a law is",
    "half_space": "what tractions do to an elastic half-space",
    "geometry": "distances, samples, closed surfaces",
    "math": "lanes, small matrices, frames",
}
INCLUDE = re.compile(r'^\s*#\s*include\s*"systems/([^"]+)"', re.MULTILINE)
WIDTH, BOX_HEIGHT, GAP, ROW = 960, 46, 16, 90


def room_of(path):
    """The room of a path below systems/."""
    parts = pathlib.PurePosixPath(path).parts
    return parts[0] if len(parts) > 1 else "step"


def read_arrows():
    """{room: rooms that it includes}."""
    listed = subprocess.run(["git", "ls-files", "systems/*.cpp", "systems/*.hpp"], cwd=ROOT, check=True,
                            capture_output=True, text=True)
    arrows = {}
    for file in listed.stdout.splitlines():
        if not (ROOT / file).is_file():
            continue
        text = (ROOT / file).read_text(encoding="utf-8")
        room = room_of(file.removeprefix("systems/"))
        arrows.setdefault(room, set()).update(room_of(target) for target in INCLUDE.findall(text))
    for room, below in arrows.items():
        below.discard(room)
    return arrows


def floor_of(room, arrows):
    """0 for a room that includes none, else one above the highest that it includes."""
    return max((floor_of(below, arrows) + 1 for below in arrows[room]), default=0)


def direct_arrows(arrows):
    """The arrows that do not follow from others: a room that includes another one over a third is left out."""
    def reaches(room):
        return set().union(*({below} | reaches(below) for below in arrows[room])) if arrows[room] else set()
    return [(room, below) for room in sorted(arrows) for below in sorted(arrows[room])
            if not any(below in reaches(between) for between in arrows[room] if between != below)]


def draw(arrows):
    """The picture as text."""
    floors = {}
    for room in PURPOSE:
        floors.setdefault(floor_of(room, arrows), []).append(room)
    height = ROW * len(floors) + GAP
    places = {}
    for floor, rooms in floors.items():
        width = (WIDTH - GAP * (len(rooms) + 1)) / len(rooms)
        width = min(width, 420)
        left = (WIDTH - len(rooms) * width - (len(rooms) - 1) * GAP) / 2
        for index, room in enumerate(rooms):
            places[room] = (left + index * (width + GAP), height - (floor + 1) * ROW + GAP, width)
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" font-family="sans-serif">',
             f'<rect width="{WIDTH}" height="{height}" fill="#ffffff"/>',
             '<defs><marker id="a" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" markerHeight="7" '
             'orient="auto"><path d="M0 0L8 4L0 8z" fill="#8a94a0"/></marker></defs>']
    for room, below in direct_arrows(arrows):
        x, y, width = places[room]
        to_x, to_y, to_width = places[below]
        start, end = x + width / 2, min(max(x + width / 2, to_x + 12), to_x + to_width - 12)
        lines.append(f'<line x1="{start:.0f}" y1="{y + BOX_HEIGHT}" x2="{end:.0f}" y2="{to_y}" stroke="#8a94a0" '
                     'stroke-width="1.2" marker-end="url(#a)"/>')
    for room, (x, y, width) in places.items():
        name = "step.cpp, laws.cpp" if room == "step" else f"{room}/"
        lines += [f'<rect x="{x:.0f}" y="{y}" width="{width:.0f}" height="{BOX_HEIGHT}" rx="6" fill="#eef3f8" '
                  'stroke="#4a6a8a"/>',
                  f'<text x="{x + width / 2:.0f}" y="{y + 20}" text-anchor="middle" font-size="14" '
                  f'font-weight="bold" fill="#1d2b3a">{name}</text>',
                  f'<text x="{x + width / 2:.0f}" y="{y + 34}" text-anchor="middle" font-size="11" '
                  f'fill="#1d2b3a">{PURPOSE[room]}</text>']
    return "\n".join(lines + ["</svg>", ""])


def main():
    arrows = read_arrows()
    if set(arrows) != set(PURPOSE):
        print(f"docs/draw_rooms.py: no purpose for {sorted(set(arrows) ^ set(PURPOSE))}")
        return 1
    picture = draw(arrows)
    if sys.argv[1:] == ["--check"]:
        same = PICTURE.is_file() and PICTURE.read_text(encoding="utf-8") == picture
        print("docs/rooms.svg is that of the files" if same else "docs/rooms.svg is old: run docs/draw_rooms.py")
        return 0 if same else 1
    PICTURE.write_text(picture, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
