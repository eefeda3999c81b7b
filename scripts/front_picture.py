#!/usr/bin/python3
"""Draws a drive from above: map, odometry and truth as the nodes publish them, with the matches of each image above.

Usage: front_picture.py BAG|KITTI_FOLDER PICTURE.png|MOTION.gif [--without-images] [--speed TIMES]

Plays the recording through replay.launch or kitti.launch (the package must be known to the shell: . _b/devel/setup.sh),
at a quarter of its speed, as pictures that come late are not drawn. KITTI's licence keeps its images out of this
package: --without-images draws the map alone. A GIF takes ImageMagick.
"""
import argparse
import os
import subprocess
import sys
import tempfile
import threading

from ports import find_free_port

MAP_PX = (960, 330)  # width, height
MAX_GIF_FRAMES = 24
WHITE, ORANGE, GREY = (255, 255, 255), (30, 140, 255), (120, 120, 120)  # BGR


class Drive:
    """What the nodes have published so far."""

    def __init__(self):
        self.lock = threading.Lock()
        self.landmarks = self.odometry = self.truth = None
        self.frames = []  # (picture of the matches, landmarks, odometry, truth)

    def see_landmarks(self, message):
        points = numpy.frombuffer(message.data, numpy.uint8).reshape(-1, message.point_step)[:, :12]
        with self.lock:
            self.landmarks = numpy.ascontiguousarray(points).view(numpy.float32)

    def see_path(self, name, message):
        positions = [(pose.pose.position.x, pose.pose.position.y) for pose in message.poses]
        with self.lock:
            setattr(self, name, numpy.array(positions).reshape(-1, 2))

    def see_matches(self, message):
        picture = numpy.frombuffer(message.data, numpy.uint8).reshape(message.height, message.step)
        picture = picture[:, :3 * message.width].reshape(message.height, message.width, 3)
        with self.lock:
            self.frames.append((picture.copy(), self.landmarks, self.odometry, self.truth))


class View:
    """The map from above, ahead to the right: the whole way and what lies around it."""

    def __init__(self, way, size_px):
        self.width_px, self.height_px = size_px
        low, high = way.min(0), way.max(0)
        length_m = max(high - low)
        low = low - [2, max(3, 0.12 * length_m)]
        high = high + [max(6, 0.15 * length_m), max(3, 0.12 * length_m)]
        self.scale = min(size_px / (high - low))
        self.corner = numpy.array([low[0], (low[1] + high[1]) / 2 + self.height_px / 2 / self.scale])

    def pixels(self, positions):
        shifted = (positions[:, :2] - self.corner) * [self.scale, -self.scale]
        return numpy.round(shifted).astype(numpy.int32)

    def draw(self, landmarks, odometry, truth):
        picture = numpy.full((self.height_px, self.width_px, 3), 24, numpy.uint8)
        if landmarks is not None and len(landmarks):
            heights = landmarks[:, 2]
            low, high = numpy.percentile(heights, [5, 95])
            levels = numpy.clip(40 + (heights - low) / max(high - low, 0.1) * 200, 40, 240).astype(numpy.uint8)
            colours = cv2.applyColorMap(levels.reshape(-1, 1), cv2.COLORMAP_TURBO).reshape(-1, 3)
            pixels = self.pixels(landmarks)
            seen = ((pixels >= 0) & (pixels < [self.width_px - 1, self.height_px - 1])).all(1)
            for right, down in ((0, 0), (1, 0), (0, 1), (1, 1)):
                picture[pixels[seen, 1] + down, pixels[seen, 0] + right] = colours[seen]
        for way, colour, width_px in ((truth, WHITE, 5), (odometry, ORANGE, 2)):
            if way is not None and len(way) > 1:
                cv2.polylines(picture, [self.pixels(way)], False, colour, width_px, cv2.LINE_AA)
        self.label(picture, landmarks, odometry)
        return picture

    def label(self, picture, landmarks, odometry):
        def write(text, x, y, colour):
            cv2.putText(picture, text, (x, y), cv2.FONT_HERSHEY_SIMPLEX, 0.5, colour, 1, cv2.LINE_AA)
        write("odometry", 12, 22, ORANGE)
        write("truth", 100, 22, WHITE)
        if odometry is not None and len(odometry) > 1:
            length_m = numpy.linalg.norm(numpy.diff(odometry, axis=0), axis=1).sum()
            number = 0 if landmarks is None else len(landmarks)
            write(f"{length_m:.1f} m, {number} landmarks", 12, self.height_px - 14, WHITE)
        step_m = 10 if self.scale < 20 else 1
        right, bottom = self.width_px - 16, self.height_px - 14
        cv2.line(picture, (int(right - step_m * self.scale), bottom), (right, bottom), GREY, 2)
        write(f"{step_m} m", int(right - step_m * self.scale), bottom - 8, GREY)


def write_picture(path, drive, with_images):
    frames = [frame for frame in drive.frames if frame[2] is not None and len(frame[2]) > 1]
    if not frames:
        sys.exit("front_picture: the nodes published no matches and no path")
    # What came after the last image belongs to it.
    frames[-1] = (frames[-1][0], drive.landmarks, drive.odometry, drive.truth)
    ways = [way for way in (drive.odometry, drive.truth) if way is not None and len(way)]
    image_px = numpy.array(frames[-1][0].shape[1::-1])
    size_px = numpy.array([round(0.4 * MAP_PX[0]), MAP_PX[1]]) if with_images else numpy.array(MAP_PX)
    view = View(numpy.vstack(ways), size_px)

    def draw(frame):
        above = view.draw(*frame[1:])
        if not with_images:
            return above
        image = cv2.resize(frame[0], tuple(image_px * MAP_PX[1] // image_px[1]), interpolation=cv2.INTER_AREA)
        return numpy.hstack([image, above])
    if not path.endswith(".gif"):
        cv2.imwrite(path, draw(frames[-1]))
        return
    chosen = frames[::-(-len(frames) // MAX_GIF_FRAMES)]
    with tempfile.TemporaryDirectory() as folder:
        names = []
        for i, frame in enumerate(chosen + [frames[-1]] * 8):
            picture = draw(frame)
            names.append(f"{folder}/{i:03}.png")
            cv2.imwrite(names[-1], picture)
        subprocess.run(["convert", "-delay", "15", "-loop", "0", *names, "-resize", "80%", "+dither", "-colors", "64",
                        "-layers", "OptimizeFrame", path], check=True)


def play(recording, speed, drive):
    """Runs the launch file to its end and listens."""
    os.environ["ROS_MASTER_URI"] = f"http://localhost:{find_free_port()}"
    if os.path.isdir(recording):
        arguments = ["kitti.launch", f"sequence:={recording}", f"rate_hz:={10 * speed}"]
    else:
        arguments = ["replay.launch", f"bag:={recording}", f"rate:={speed}"]
    launch = subprocess.Popen(["roslaunch", "arfm_vo", *arguments, "rviz:=false"], stdout=subprocess.DEVNULL)
    rospy.init_node("front_picture", disable_signals=True)
    rospy.Subscriber("landmarks", PointCloud2, drive.see_landmarks)
    rospy.Subscriber("path", Path, lambda message: drive.see_path("odometry", message))
    rospy.Subscriber("path_truth", Path, lambda message: drive.see_path("truth", message))
    rospy.Subscriber("matches_image", Image, drive.see_matches, queue_size=10, buff_size=1 << 26)
    code = launch.wait()
    if code != 0:
        sys.exit(f"front_picture: roslaunch ended with {code}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recording")
    parser.add_argument("picture")
    parser.add_argument("--without-images", action="store_true")
    parser.add_argument("--speed", type=float, default=0.25)
    arguments = parser.parse_args()
    if not os.path.exists(arguments.recording):
        sys.exit(f"front_picture: {arguments.recording}: no such bag or KITTI folder")
    global cv2, numpy, rospy, Image, Path, PointCloud2
    import cv2
    import numpy
    import rospy
    from nav_msgs.msg import Path
    from sensor_msgs.msg import Image, PointCloud2
    drive = Drive()
    play(os.path.abspath(arguments.recording), arguments.speed, drive)
    write_picture(arguments.picture, drive, not arguments.without_images)


if __name__ == "__main__":
    main()
