"""Messages with the fields that geometry_msgs gives them, which take no other."""


class Vector3:
    __slots__ = ("x", "y", "z")

    def __init__(self):
        self.x = self.y = self.z = 0.0


class Quaternion(Vector3):
    __slots__ = ("w",)

    def __init__(self):
        super().__init__()
        self.w = 1.0


class Header:
    __slots__ = ("stamp", "frame_id")

    def __init__(self):
        self.stamp, self.frame_id = None, ""


class Pose:
    __slots__ = ("position", "orientation")

    def __init__(self):
        self.position, self.orientation = Vector3(), Quaternion()


class Wrench:
    __slots__ = ("force", "torque")

    def __init__(self):
        self.force, self.torque = Vector3(), Vector3()


class PoseStamped:
    __slots__ = ("header", "pose")

    def __init__(self):
        self.header, self.pose = Header(), Pose()


class WrenchStamped:
    __slots__ = ("header", "wrench")

    def __init__(self):
        self.header, self.wrench = Header(), Wrench()
