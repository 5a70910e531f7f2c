"""What examples/gateway/ros2_node.py calls of rclpy. spin() plays a handle that goes down by 4 mm (-z of ROS) within a
second, and says what came back."""

import time

from geometry_msgs.msg import PoseStamped

published = {}
subscribed = {}


def init():
    pass


def spin(_node):
    start = time.monotonic()
    highest = 0.0
    while (now := time.monotonic() - start) < 3.0:
        handle = PoseStamped()
        handle.pose.position.z = -0.004 * min(max(now - 0.5, 0.0), 1.0)
        handle.pose.orientation.w = 1.0
        subscribed["handle"](handle)
        force = published["wrench"].wrench.force
        highest = max(highest, force.z)
        time.sleep(1e-3)
    print(f"force {force.x:.4f} {force.y:.4f} {force.z:.4f} up to {highest:.4f}, tool at "
          f"{published['tool'].pose.position.z:.4f}")
