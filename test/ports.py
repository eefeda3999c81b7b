#!/usr/bin/python3
"""Ports for a ROS master, or a bus, of one's own, so that no other on the machine is disturbed. Called, it prints one."""
import itertools
import socket


def find_free_port():
    """A TCP port that the system gives."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def is_free(port):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as end:
        try:
            end.bind(("127.0.0.1", port))
        except OSError:
            return False
    return True


def find_bus_port(first):
    """The first PORT from `first` on of which UDP ports PORT1 and PORT2 are free."""
    return next(port for port in itertools.count(first) if is_free(10 * port + 1) and is_free(10 * port + 2))


if __name__ == "__main__":
    print(find_free_port())
