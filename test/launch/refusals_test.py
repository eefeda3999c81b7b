#!/usr/bin/python3
"""What the launch files refuse, and what they say.

Usage: refusals_test.py BUILD_DIR SOURCE_DIR
"""
import os
import sys
import unittest

from launch_case import FIXTURE, SOURCE_DIR, LaunchCase


class RefusalsTest(LaunchCase):
    def test_a_bag_that_is_not_there_is_refused_with_its_full_path(self):
        self.assertIn(f"{self.folder}/none.bag: no such file", self.refuse("bag:=none.bag"))

    def test_a_folder_that_is_not_there_is_refused_with_its_full_path(self):
        code, console = self.launch("kitti.launch", "sequence:=none", "rviz:=false")
        self.assertNotEqual(code, 0)
        self.assertIn(self.folder + "/none", console)

    def test_a_bag_with_one_camera_is_refused_with_what_it_has(self):
        self.write_bag("left.bag", lambda topic, message: (topic, message) if "/right/image" not in topic else None)
        console = self.refuse("bag:=left.bag")
        self.assertIn("has no topic /stereo/right/image_rect", console)
        self.assertIn("its cameras are /stereo/left/camera_info, /stereo/left/image_rect", console)

    def test_each_launch_file_refuses_an_argument_that_it_has_not(self):
        self.assertIn("no argument base_fram:= (is base_frame:= meant?)", self.refuse("bag:=" + FIXTURE, "base_fram:=a"))
        for name in sorted(name for name in os.listdir(os.path.join(SOURCE_DIR, "launch")) if name.endswith(".launch")):
            code, console = self.launch(name, "sequence:=.", "bag:=" + FIXTURE, "no_such:=1", limit_s=60)
            self.assertNotEqual(code, 0, console)
            self.assertRegex(console, name + " has no argument (sequence|bag|no_such):=")

    def test_a_damaged_bag_is_refused(self):
        with open(FIXTURE, "rb") as source, open(os.path.join(self.folder, "half.bag"), "wb") as bag:
            bag.write(source.read(1000000))
        self.assertIn("half.bag: cannot be read", self.refuse("bag:=half.bag"))

    def test_a_second_odometry_of_the_same_name_is_refused_and_the_first_goes_on(self):
        code, console = self.run_command("bash", "-c", """set -m
            roslaunch arfm_vo odometry.launch > /dev/null &
            until rosnode ping -c 1 /pose_node 2>&1 | grep -q reply; do sleep 0.5; done
            roslaunch arfm_vo odometry.launch 2>&1
            roslaunch --nodes arfm_vo odometry.launch namespace:=/second
            rosnode ping -c 1 /pose_node
            kill -INT %1; wait""")
        self.assertIn("/pose_node runs already on http", console)
        self.assertIn("/second/pose_node", console)
        self.assertIn("xmlrpc reply from", console)
        self.assertEqual(code, 0, console)

    def test_a_name_that_a_killed_node_left_to_the_master_may_be_taken(self):
        code, console = self.run_command("bash", "-c", """set -m
            roscore -p ${ROS_MASTER_URI##*:} > /dev/null 2>&1 &
            until rosnode list > /dev/null 2>&1; do sleep 0.5; done
            /usr/bin/python3 -c 'import rospy; rospy.init_node("pose_node"); rospy.spin()' & pid=$!
            until rosnode ping -c 1 /pose_node 2>&1 | grep -q reply; do sleep 0.5; done
            check_running.py / pose_node || echo "refused while it runs"
            kill -9 $pid; rosnode list
            check_running.py / pose_node && echo "taken"
            kill -INT %1; wait""".replace("check_running.py", os.path.join(SOURCE_DIR, "launch", "check_running.py")))
        self.assertRegex(console, "(?s)/pose_node runs already on .*refused while it runs.*/pose_node.*\ntaken")

    def test_a_mistyped_parameter_ends_the_replay_and_is_named(self):
        with open(os.path.join(self.folder, "config.yaml"), "w") as file:
            file.write("frontend: {no_such_key: 1}\n")
        for nodelets in "false", "true":
            code, console = self.launch("replay.launch", "rviz:=false", "bag:=" + FIXTURE, f"config:={self.folder}/config.yaml",
                                        "nodelets:=" + nodelets)
            self.assertNotEqual(code, 124, console)  # it ended by itself
            self.assertIn("frontend.no_such_key: unknown key", console)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)
