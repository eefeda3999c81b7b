"""Malformed messages of any type, made from the message definitions."""
import time

import genpy
import rosgraph
import roslib.message
import rospy

NUMBERS = (float("nan"), float("inf"), float("-inf"), 1e308, -1.0, 0.0, 1e-300, 123.4)
STRINGS = ("", "map", "base_link", "mono8", "%s%n", "x" * 5000, "\0")


def subscribed_topics():
    """[(topic, class)] of what the other nodes subscribe to, by the master."""
    master = rosgraph.Master("/message_generator")
    kinds = dict(master.getTopicTypes())
    subscribers = master.getSystemState()[1]
    topics = [topic for topic, names in subscribers if any(name != rospy.get_name() for name in names)]
    return [(topic, roslib.message.get_message_class(kinds[topic])) for topic in sorted(topics) if kinds.get(topic, "*") != "*"]


def elements(field):
    """(type of the elements, number: None where it may be any) of an array, else None."""
    if not field.endswith("]"):
        return None
    element, _, size = field[:-1].rpartition("[")
    return element, int(size) if size else None


def class_of(field):
    """Of a field that is a message of its own, else None."""
    is_message = "/" in field or field[0].isupper()
    return roslib.message.get_message_class(field if "/" in field else "std_msgs/" + field) if is_message else None


def has_floats(kind):
    for field in kind._slot_types:
        base = (elements(field) or (field,))[0]
        if base.startswith("float") or (class_of(base) and has_floats(class_of(base))):
            return True
    return False


def fill_with_nan(message):
    """Each floating point number in it; arrays that are empty get an element."""
    for name, field in zip(message.__slots__, message._slot_types):
        value, array = getattr(message, name), elements(field)
        if class_of(field):
            fill_with_nan(value)
        elif array and class_of(array[0]):
            setattr(message, name, value or [class_of(array[0])()])
            for element in getattr(message, name):
                fill_with_nan(element)
        elif array and array[0].startswith("float"):
            setattr(message, name, [float("nan")] * (len(value) or 1))
        elif field.startswith("float"):
            setattr(message, name, float("nan"))


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
        if elements(field):
            element, size = elements(field)
            values = [self.draw(element) for _ in range(self.engine.choice((0, 1, 3, 40)) if size is None else size)]
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
        return self.make(class_of(field))

    def draw_integer(self, field):
        bits = {"byte": 8, "char": 8}.get(field) or int(field.lstrip("uint"))
        low, high = (0, 2**bits - 1) if field.startswith("u") or field == "char" else (-2**(bits - 1), 2**(bits - 1) - 1)
        return self.engine.choice((low, high, 0, 1, self.engine.randint(low, high)))
