"""Malformed messages of any type, made from the message definitions."""
import time

import genpy
import rosgraph
import roslib.message
import rospy

NUMBERS = (float("nan"), float("inf"), float("-inf"), 1e308, -1.0, 0.0, 1e-300, 123.4)
STRINGS = ("", "map", "base_link", "mono8", "%s%n", "x" * 5000, "\0")


def subscribed_topics(nodes):
    """[(topic, class)] of what the nodes subscribe to, by the master."""
    master = rosgraph.Master("/message_generator")
    kinds = dict(master.getTopicTypes())
    subscribers = master.getSystemState()[1]
    topics = [topic for topic, names in subscribers if any(name.lstrip("/") in nodes for name in names)]
    return [(topic, roslib.message.get_message_class(kinds[topic])) for topic in sorted(topics) if kinds.get(topic, "*") != "*"]


class MessageGenerator:
    def __init__(self, engine):
        self.engine = engine

    def make(self, kind):
        """A message whose fields are all drawn anew."""
        message = kind()
        for name, field in zip(kind.__slots__, kind._slot_types):
            setattr(message, name, self.draw(field))
        return message

    def draw(self, field):
        if field.endswith("]"):
            element, _, size = field[:-1].rpartition("[")
            values = [self.draw(element) for _ in range(int(size) if size else self.engine.choice((0, 1, 3, 40)))]
            return bytes(values) if element in ("uint8", "char") else values
        if field in ("time", "duration"):
            kind = genpy.Time if field == "time" else genpy.Duration
            return kind(self.engine.choice((0, 1, int(time.time()), 2**31 - 1)), self.engine.randrange(10**9))
        if field == "string":
            return self.engine.choice(STRINGS)
        if field == "bool":
            return self.engine.random() < 0.5
        if field.startswith("float"):
            number = self.engine.choice(NUMBERS)
            return number if field == "float64" or abs(number) < 1e38 else float("inf")
        if "/" not in field and ("int" in field or field in ("byte", "char")):
            return self.draw_integer(field)
        return self.make(roslib.message.get_message_class(field if "/" in field else "std_msgs/" + field))

    def draw_integer(self, field):
        bits = {"byte": 8, "char": 8}.get(field) or int(field.lstrip("uint"))
        low, high = (0, 2**bits - 1) if field.startswith("u") or field == "char" else (-2**(bits - 1), 2**(bits - 1) - 1)
        return self.engine.choice((low, high, 0, 1, self.engine.randint(low, high)))

    def publish(self, topic, kind, count):
        publisher = rospy.Publisher(topic, kind, queue_size=count)
        end = time.monotonic() + 5
        while publisher.get_num_connections() == 0 and time.monotonic() < end:
            time.sleep(0.01)
        for _ in range(count):
            publisher.publish(self.make(kind))
        time.sleep(0.2)
        publisher.unregister()
