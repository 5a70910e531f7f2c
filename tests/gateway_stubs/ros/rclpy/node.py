import rclpy


class Publisher:
    def __init__(self, kind, topic):
        self.kind, self.topic = kind, topic

    def publish(self, message):
        assert isinstance(message, self.kind)
        rclpy.published[self.topic] = message


class Node:
    def __init__(self, name):
        self.name, self.parameters = name, {}

    def declare_parameter(self, name, value):
        self.parameters[name] = type("Parameter", (), {"value": value})

    def get_parameter(self, name):
        return self.parameters[name]

    def create_publisher(self, kind, topic, _qos):
        return Publisher(kind, topic)

    def create_subscription(self, _kind, topic, callback, _qos):
        rclpy.subscribed[topic] = callback

    def destroy_node(self):
        pass
