#!/usr/bin/env python3
"""A ROS 2 node that holds Torsion's tool with a pose topic and publishes what the hand is to feel:

    torsion view scenes/ball_on_cube_soft.gltf --device gateway &
    python3 ros2_node.py --ros-args -p frame:=tool_base

Subscribes to `handle` (geometry_msgs/PoseStamped, metres, of the handle from the middle of its workspace) and publishes
`wrench` (geometry_msgs/WrenchStamped) and `tool` (geometry_msgs/PoseStamped), one of each for each pose. ROS has z up and x
ahead (REP 103): +x away from the user, +y to the left. Run here against a stand-in for rclpy: it was not tried under ROS.
"""

import rclpy
from geometry_msgs.msg import PoseStamped, WrenchStamped
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data

from torsion_gateway import Gateway


def to_torsion(x, y, z):
    """x ahead, y left, z up to x right, y up, z towards the user."""
    return (-y, z, -x)


def to_ros(v):
    return (-v[2], -v[0], v[1])


class Torsion(Node):
    def __init__(self):
        super().__init__("torsion_gateway")
        self.declare_parameter("address", "7747")  # or HOST:PORT, with a secret
        self.declare_parameter("secret", "")
        self.declare_parameter("frame", "torsion")
        self.gateway = Gateway(self.get_parameter("address").value, secret=self.get_parameter("secret").value or None)
        self.frame = self.get_parameter("frame").value
        self.wrench = self.create_publisher(WrenchStamped, "wrench", qos_profile_sensor_data)
        self.tool = self.create_publisher(PoseStamped, "tool", qos_profile_sensor_data)
        self.create_subscription(PoseStamped, "handle", self.on_handle, qos_profile_sensor_data)

    def on_handle(self, message):
        p, q = message.pose.position, message.pose.orientation
        answer = self.gateway.exchange(to_torsion(p.x, p.y, p.z), (*to_torsion(q.x, q.y, q.z), q.w))
        felt = WrenchStamped()
        felt.header.stamp, felt.header.frame_id = message.header.stamp, self.frame
        if answer is not None:
            f, t = to_ros(answer.force), to_ros(answer.torque)
            felt.wrench.force.x, felt.wrench.force.y, felt.wrench.force.z = f
            felt.wrench.torque.x, felt.wrench.torque.y, felt.wrench.torque.z = t
            place = PoseStamped()
            place.header = felt.header
            at, turn = to_ros(answer.tool_position), to_ros(answer.tool_rotation[:3])
            place.pose.position.x, place.pose.position.y, place.pose.position.z = at
            place.pose.orientation.x, place.pose.orientation.y, place.pose.orientation.z = turn
            place.pose.orientation.w = answer.tool_rotation[3]
            self.tool.publish(place)
        self.wrench.publish(felt)  # without force where nothing came


def main():
    rclpy.init()
    node = Torsion()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.gateway.close()
        node.destroy_node()


if __name__ == "__main__":
    main()
