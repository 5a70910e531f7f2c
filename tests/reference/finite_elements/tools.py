"""Rigid tools: callables (position, displacement, depth, phi) -> gap (n) [m], normal (n, 3).

position and displacement (n, 3) are those of points of the body, depth [m] how far the tool was
lowered since it touched, phi [rad] its turn about z. The normal points out of the tool. `moved`
says whether the tool meets the points where they went (1) or where they were (0).
"""

import numpy as np


class Ball:
    """Pressed on the plane z = 0 as linear theory has it: heights above the undeformed plane."""
    moved = 0.0

    def __init__(self, radius):
        self.radius = radius

    def __call__(self, position, displacement, depth, phi):
        square = position[:, 0] ** 2 + position[:, 1] ** 2
        height = self.radius - np.sqrt(self.radius ** 2 - square)
        normal = np.broadcast_to([0.0, 0.0, -1.0], position.shape)
        return height - depth - displacement[:, 2], normal


class Rod:
    """A round rod with round ends, its middle line from -end to end: the true distance from the
    points where they went, in the frame of the turned rod. A ball where the ends coincide."""
    moved = 1.0

    def __init__(self, radius, start, end):
        self.radius = radius
        self.start, self.end = np.array(start), np.array(end)

    def __call__(self, position, displacement, depth, phi):
        cosine, sine = np.cos(phi), np.sin(phi)
        turn = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
        points = (position + displacement + [0.0, 0.0, depth]) @ turn  # turned back by phi
        along = self.end - self.start
        length = along @ along
        share = (points - self.start) @ along / length if length > 0.0 else np.zeros(len(points))
        away = points - self.start - np.clip(share, 0.0, 1.0)[:, None] * along
        distance = np.linalg.norm(away, axis=1)
        return distance - self.radius, (away / distance[:, None]) @ turn.T
