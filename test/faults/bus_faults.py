"""Faults of the chassis and of the bus to it."""
import random
import struct
import time

import bus_tap as bus
from fault import Fault
from ports import find_bus_port


def set_byte(identifier, index, value):
    def change(frame):
        if frame.id == identifier:
            frame.bytes[index] = value
        return frame
    return change


def tell_speed(speed_mmps):
    motion = bus.make_frame(bus.MOTION_STATE, struct.pack(">hh", speed_mmps, 0))
    return lambda frame: motion if frame.id == bus.MOTION_STATE else frame


class Repeat:
    """The first bytes of each message, or of one kind, stay as they were first."""

    def __init__(self, identifier=None, size=8):
        self.identifier, self.size, self.first = identifier, size, {}

    def __call__(self, frame):
        if self.identifier in (None, frame.id):
            frame.bytes[:self.size] = self.first.setdefault(frame.id, bytes(frame.bytes[:self.size]))
        return frame


def creep(campaign):
    """The rover is told to stand, and both tracks creep on at 25 mm/s."""
    campaign.rover.call("chassis_node/cancel")
    time.sleep(1.5)
    campaign.obey(tell_speed(25))


def heal(campaign):
    campaign.obey(lambda frame: frame)
    time.sleep(0.5)


def clear(campaign):
    heal(campaign)
    campaign.rover.call("chassis_node/clear_errors")


def fuzz(campaign):
    engine = random.Random(1)
    for _ in range(3000):
        identifier = engine.randrange(0x422, 0x800)
        campaign.tap.inject(bus.make_frame(identifier, engine.randbytes(engine.randrange(9))))


def flood(campaign):
    for i in range(20000):
        campaign.tap.inject(bus.make_frame(0x3FF, [1, 2, 3]))
        if i % 160 == 0:
            time.sleep(0.02)


def come_back_as_another(campaign):
    """The CAN adapter is pulled and put in again, and has become can1: another port of UDP."""
    campaign.tap.unplug()
    time.sleep(0.5)
    campaign.tap.plug(find_bus_port(campaign.tap.driver_port + 2))


def come_back_as_itself(campaign):
    campaign.tap.unplug()
    campaign.tap.plug(campaign.tap.driver_port)
    time.sleep(1)


def storm(campaign):
    """The bus goes off and comes back 50 times."""
    for _ in range(50):
        frame = bus.make_frame(0, [])
        frame.kind = bus.BUS_OFF
        campaign.tap.inject(frame)
        time.sleep(0.02)


def bus_faults():
    def changed(change):
        return lambda campaign: campaign.obey(change() if isinstance(change, type) else change)

    def held(size):  # of the odometer: the left track, or both
        return lambda campaign: campaign.obey(Repeat(bus.ODOMETER, size))
    state = bus.SYSTEM_STATE
    return [
        Fault("emergency stop button", changed(set_byte(state, 0, 1)), "emergency stop button of the chassis is pressed", heal),
        Fault("chassis fault", changed(set_byte(state, 0, 2)), "chassis reports a fault", clear),
        *(Fault("error bits 0x%02X in byte %d" % (bits, byte), changed(set_byte(state, byte, bits)), "chassis reports a fault", clear)
          for byte, bits in ((4, 1), (4, 2), (5, 1), (5, 8), (5, 128))),
        Fault("remote control takes over", changed(set_byte(state, 1, 3)), "remote control has the rover", heal),
        *(Fault("remote control is lost (byte %d)" % byte, changed(set_byte(state, byte, 4)), "chassis has lost its remote control", heal)
          for byte in (4, 5)),
        Fault("chassis falls into standby", changed(set_byte(state, 1, 0)), "chassis takes no commands over CAN", heal),
        Fault("chassis falls silent", changed(lambda frame: None), "chassis is silent", heal, 0.5),
        *(Fault("0x%03X falls silent" % silent, changed(lambda frame, silent=silent: None if frame.id == silent else frame),
                "chassis is silent", heal, 0.5) for silent in (bus.ODOMETER, state, bus.MOTION_STATE, 0x251, bus.MOTOR_STATUS[1])),
        *(Fault(name, changed(set_byte(bus.MOTOR_STATUS[0], 5, bits)), "motor or its driver reports a fault", heal) for name, bits in (
            ("motor driver reports an overload", 0x44), ("motor is too hot", 0x42), ("motor driver is too hot", 0x48))),
        Fault("tracks run away at 0.2 m/s", changed(tell_speed(200)),  # chassis_guard's clock is not simulated: it may be first
              "tracks run faster than commanded or software emergency stop is set", heal, 0.2),
        Fault("left track is jammed", held(4), "a track is jammed", heal, 2),
        Fault("rover slides: the cameras go on, both tracks are told to stand", held(8),
              "rover moves otherwise than its tracks or pose contradicts the tracks or a track is jammed", heal, 2),
        Fault("rover creeps at rest", creep, "rover moves without a command", heal, 2),
        Fault("feedback repeats itself", changed(Repeat), "feedback of the chassis is frozen", heal, 1.1),
        *(Fault("another driver sends 0x%03X" % sent, lambda c, sent=sent: c.tap.inject(bus.make_frame(sent, [0] * 8)),
                "another driver commands the chassis", lambda c: time.sleep(1.2)) for sent in (0x111, 0x131, 0x421)),
        Fault("CAN adapter is pulled and comes back as can1 (another UDP port)", come_back_as_another, "CAN bus is down or chassis is silent",
              come_back_as_itself, 0.5, is_well=lambda c: not c.rover.call("chassis_node/start").success),
        Fault("bus goes off and comes back 50 times in 1 s", storm, "CAN bus is down", lambda c: time.sleep(1)),
        Fault("3000 fuzzed frames of foreign identifiers", fuzz, "drives on"),
        Fault("flood of 20000 foreign frames", flood, "drives on"),
    ]
