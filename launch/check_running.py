#!/usr/bin/python3
"""Refuses to start a node whose name a running node has: the master would end that one.

Usage: check_running.py NAMESPACE NODE      called by odometry.launch; exit status 1 where such a node answers
"""
import socket
import sys
import xmlrpc.client

import rosgraph

LIMIT_S = 2


def is_running(name):
    """Whether a node that the master knows by this name answers; one that was killed does not."""
    socket.setdefaulttimeout(LIMIT_S)
    try:
        address = rosgraph.Master("/check_running").lookupNode(name)
        return xmlrpc.client.ServerProxy(address).getPid("/check_running")[0] == 1
    except (OSError, rosgraph.MasterException, xmlrpc.client.Error):
        return False


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    name = rosgraph.names.ns_join(sys.argv[1], sys.argv[2])
    if is_running(name):
        sys.exit(f"ERROR: {name} runs already on {rosgraph.get_master_uri()}: end it first, or give this one a "
                 "namespace:= of its own (a second robot)")


if __name__ == "__main__":
    main()
