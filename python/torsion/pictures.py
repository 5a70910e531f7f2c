"""Pictures of scenes, drawn by the program torsion, and curves of runs as SVG, for notebooks."""
import base64
import html
import io
import os
import pathlib
import shutil
import subprocess
import tempfile

import numpy as np

from ._torsion import load

# What may be changed of a body and the program sets as well.
KEYS = ("youngs_modulus", "poisson_ratio", "density", "static_friction", "dynamic_friction", "tolerance",
        "contact_model", "body_model")
COLORS = ("#1f5fa8", "#c03020", "#2a8a50", "#8a5aa8")


def _program():
    """The program torsion: TORSION_PROGRAM, or on the PATH, or beside the build's module."""
    named = os.environ.get("TORSION_PROGRAM")
    beside = pathlib.Path(__file__).parents[2] / "torsion"
    found = named or shutil.which("torsion") or (str(beside) if beside.is_file() else None)
    if found is None:
        raise FileNotFoundError("pictures are drawn by the program torsion, which is not on the PATH; install the "
                                "package torsion, or name it by TORSION_PROGRAM")
    return found


def _settings(scene):
    """--set for what differs from the scene's file."""
    words = []
    in_file = load(scene.path)
    for name in scene.bodies:
        for key in KEYS:
            value = getattr(scene[name], key)
            if value != getattr(in_file[name], key):
                words += ["--set", f"{name}.{key}={value}"]
    return words


def picture(scene, at, size=(640, 480), heat="twist"):
    """A PNG file's bytes: the scene at a moment [s] of its file's animation, with what was changed of its bodies.

    scene: by load(), or a path. heat: what colours show, "twist", "pressure" or "none".
    """
    if isinstance(scene, (str, os.PathLike)):
        scene = load(os.fspath(scene))
    if not scene.path:
        raise ValueError("a scene made by code has no file that could be drawn; use a Surface")
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "picture.png"
        words = [_program(), "render", scene.path, "--at", str(float(at)), "--out", str(out), "--size",
                 f"{size[0]}x{size[1]}", "--heat", heat, "--quiet", *_settings(scene)]
        ran = subprocess.run(words, capture_output=True, text=True, check=False)
        if ran.returncode != 0:
            raise ValueError(ran.stderr.strip())
        return out.read_bytes()


def render(scene, at, size=(640, 480), heat="twist"):
    """As picture(), as an array (height, width, 3) of bytes. It needs Pillow (python3-pil)."""
    from PIL import Image

    with Image.open(io.BytesIO(picture(scene, at, size, heat))) as image:
        return np.asarray(image.convert("RGB"))


def curve_svg(time, curves, label, width=420, height=200):
    """One plot: curves is {name: values}."""
    left, right, top, bottom = 62, 10, 22, 30
    values = np.concatenate([np.asarray(each, float) for each in curves.values()])
    low, high = float(values.min()), float(values.max())
    if high - low < 1e-12 * max(abs(high), 1e-300) or high == low:
        low, high = low - 1.0, high + 1.0
    span = max(float(time[-1] - time[0]), 1e-12)

    def x(t):
        return left + (t - time[0]) / span * (width - left - right)

    def y(v):
        return height - bottom - (v - low) / (high - low) * (height - top - bottom)

    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" '
             'font-size="11">',
             f'<rect x="{left}" y="{top}" width="{width - left - right}" height="{height - top - bottom}" '
             'fill="none" stroke="#999"/>']
    for value in (low, high):
        parts.append(f'<text x="{left - 4}" y="{y(value) + 4:.1f}" text-anchor="end">{value:.3g}</text>')
    parts.append(f'<text x="{left}" y="{height - 8}">{time[0]:.3g} s</text>'
                 f'<text x="{width - right}" y="{height - 8}" text-anchor="end">{time[-1]:.3g} s</text>'
                 f'<text x="{left}" y="14">{html.escape(label)}</text>')
    stride = max(1, len(time) // 1000)
    for k, (name, each) in enumerate(curves.items()):
        points = " ".join(f"{x(t):.1f},{y(v):.1f}" for t, v in zip(time[::stride], each[::stride]))
        color = COLORS[k % len(COLORS)]
        parts.append(f'<polyline points="{points}" fill="none" stroke="{color}"/>')
        if len(curves) > 1:
            parts.append(f'<text x="{width - right}" y="{14 + 13 * k}" fill="{color}" text-anchor="end">'
                         f"{html.escape(name)}</text>")
    return "".join(parts) + "</svg>"


class Summary:
    """What a notebook shows of a run: a picture of the scene at its largest couple, and the curves over time."""

    def __init__(self, scene, trace):
        """trace: by Simulation.run, of the scene's animation."""
        self.scene, self.trace = scene, trace

    def curves(self):
        """SVGs of force, couple and the share that sticks, a curve a tool."""
        time = self.trace["time"][:, 0]
        names = self.scene.tools

        def by_tool(values):
            return {names[k]: values[:, k] for k in range(values.shape[1])}

        return [curve_svg(time, by_tool(np.linalg.norm(self.trace["force"], axis=2)), "force (N)"),
                curve_svg(time, by_tool(1e3 * self.trace["couple"]), "contact couple (mN m)"),
                curve_svg(time, by_tool(self.trace["stick_share"]), "share of the contact that sticks")]

    def _repr_html_(self):
        if self.scene.path:
            at = self.trace["time"][np.abs(self.trace["couple"]).max(axis=1).argmax(), 0]
            drawn = base64.b64encode(picture(self.scene, at)).decode()
            shown = f'<img alt="the scene at {at:.3f} s" src="data:image/png;base64,{drawn}">'
        else:
            shown = ""
        return shown + "<div>" + "".join(self.curves()) + "</div>"
