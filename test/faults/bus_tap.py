"""The wire between chassis_node and the simulated chassis, both on UDP (hardware/can_bus.cpp)."""
import socket
import struct
import threading
import time

MOTION_COMMAND, SYSTEM_STATE, MOTION_STATE, ODOMETER, MOTOR_STATUS = 0x111, 0x211, 0x221, 0x311, (0x261, 0x262)

BUS_OFF = 2  # a kind of frame: the controller left the bus


class Frame:
    """A frame as hardware/can_frame.h has it in memory."""
    LAYOUT = "=B3xIB8s3x"

    def __init__(self, datagram):
        self.kind, self.id, self.dlc, data = struct.unpack(self.LAYOUT, datagram)
        self.bytes = bytearray(data)

    def datagram(self):
        return struct.pack(self.LAYOUT, self.kind, self.id, self.dlc, bytes(self.bytes))


def make_frame(identifier, data):
    return Frame(struct.pack(Frame.LAYOUT, 0, identifier, len(data), bytes(data)))


class BusTap:
    """Carries frames both ways, notes the commands by the steady clock, and does to the feedback what a test wants."""

    def __init__(self, driver_port, chassis_port):
        """The driver is on udp:PORT1:PORT2, the chassis on udp:PORT2:PORT1, of ports such as 4711."""
        self.driver_port = driver_port
        self.plug(driver_port)
        self.chassis = self._open(chassis_port * 10 + 1, chassis_port * 10 + 2)
        self.change = lambda frame: frame  # of the feedback; None drops it
        self.lock = threading.Lock()
        self.num_commands = 0
        self.moving_s = 0.0  # the last frame that moves
        self.stops_s, self.starts_s = [], []  # of each frame that stops it or sets it in motion
        self.is_moving = False
        self.ways_m = (0.0, 0.0)
        for source, sink, note in (("driver", "chassis", self._note_command), ("chassis", "driver", self._note_feedback)):
            threading.Thread(target=self._carry, args=(source, sink, note), daemon=True).start()

    @staticmethod
    def _open(local_port, peer_port):
        end = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        end.bind(("127.0.0.1", local_port))
        end.connect(("127.0.0.1", peer_port))
        end.settimeout(0.2)  # a socket that is closed meanwhile is noticed
        return end

    def _carry(self, source, sink, note):
        while True:
            try:
                frame = note(Frame(getattr(self, source).recv(64)))
                if frame is not None:
                    getattr(self, sink).send(frame.datagram())
            except OSError:
                time.sleep(0.005)  # the other end does not run, or is unplugged

    def unplug(self):
        """The driver's end of the bus is gone."""
        self.driver.close()

    def plug(self, port):
        """It is there again, under the name of that port."""
        self.driver = self._open(port * 10 + 2, self.driver_port * 10 + 1)

    def _note_command(self, frame):
        now = time.monotonic()
        with self.lock:
            self.num_commands += 1
            if frame.id == MOTION_COMMAND:
                is_moving = any(frame.bytes[:4])
                if is_moving and not self.is_moving:
                    self.starts_s.append(now)
                if is_moving:
                    self.moving_s = now
                elif self.is_moving:
                    self.stops_s.append(now)
                self.is_moving = is_moving
        return frame

    def _note_feedback(self, frame):
        if frame.id == ODOMETER:
            left_mm, right_mm = struct.unpack(">ii", frame.bytes)
            with self.lock:
                self.ways_m = (0.001 * left_mm, 0.001 * right_mm)
        return self.change(frame)

    def inject(self, frame):
        """As if another node on the bus had sent it."""
        try:
            self.driver.send(frame.datagram())
        except OSError:
            pass

    def way_m(self):
        """The mean way of both tracks, whatever the driver is told of it."""
        with self.lock:
            return sum(self.ways_m) / 2
