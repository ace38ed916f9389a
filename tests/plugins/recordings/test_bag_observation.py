"""Bags, written by rosbags, held against a design: each planted difference is found, and none in a bag as designed."""

from __future__ import annotations

import shutil
import sqlite3
import struct
from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass, field, replace
from pathlib import Path

import pytest
from rosbags.interfaces import Qos, QosDurability, QosHistory, QosLiveliness, QosReliability, QosTime
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin
from rosbags.rosbag2 import Writer as Writer2
from rosbags.typesys import Stores, get_typestore

from archgen.conformance.robot_comparison import ComparedPart
from archgen.importers.foreign_import import ForeignFileError
from archgen.importers.robot_observation import ObservationOptions, observe_robot
from archgen.plugins.recordings import bag_observation
from archgen.plugins.recordings.bag_messages import ReadingLimits, read_messages
from archgen.products.robot_conformance import ConformanceReport, hold_against_robots
from tests.cli.conftest import Run
from tests.conformance.rovers import check_rover, show_findings
from tests.property_sizes import try_some

PROJECT = """\
archgen: 1
project: {id: rover, title: Rover}
ros: {distro: jazzy}
types: {Scan: {message: sensor_msgs/msg/LaserScan, size: 1 kB}}
groups:
  sensing:
    components:
      lidar:
        outputs:
          scan: {type: Scan, promise: {rate: 10 Hz, max_gap: 200 ms, frame: laser}}
      map_server: {outputs: {map: std_msgs/msg/String}}
      camera: {outputs: {image: std_msgs/msg/String}}
nodes:
  lidar: {implements: sensing.lidar, status: existing, publishes: {scan: {topic: /scan, qos: sensor_data}}}
  map_server:
    implements: sensing.map_server
    status: existing
    publishes: {map: {topic: /map, qos: {durability: transient_local}}}
  camera: {implements: sensing.camera, status: existing, publishes: {image: /image}}
"""
_ENDLESS = QosTime(2147483647, 4294967295)
MS = 1_000_000


def make_qos(reliability: str, durability: str) -> Qos:
    """Return what rosbag2 writes of a publisher: its queue is as the recorder has it."""
    return Qos(
        QosHistory.UNKNOWN, 0, QosReliability[reliability], QosDurability[durability], _ENDLESS, _ENDLESS,
        QosLiveliness.AUTOMATIC, _ENDLESS, avoid_ros_namespace_conventions=False,
    )  # fmt: skip


def make_scan(frame: str = "laser", size: int = 500) -> bytes:
    """Return a message in CDR whose header comes first, as large as asked for."""
    text = frame.encode() + b"\0"
    head = b"\0\1\0\0" + struct.pack("<iII", 1, 2, len(text)) + text
    return head.ljust(size, b"\0")


@dataclass(frozen=True)
class Recorded:
    """One topic of a bag."""

    topic: str
    message: str
    times: Sequence[int]
    """When messages came, in ms."""
    data: bytes
    qos: Qos | None = None


@dataclass(frozen=True)
class Bag:
    """What a bag holds: as designed, where nothing is planted."""

    scan: Recorded = field(
        default_factory=lambda: Recorded(
            "/scan",
            "sensor_msgs/msg/LaserScan",
            range(0, 10_000, 100),
            make_scan(),
            make_qos("BEST_EFFORT", "VOLATILE"),
        )
    )
    map: Recorded = field(
        default_factory=lambda: Recorded(
            "/map", "std_msgs/msg/String", [50], b"\0\1\0\0\1\0\0\0\0", make_qos("RELIABLE", "TRANSIENT_LOCAL")
        )
    )
    others: tuple[Recorded, ...] = ()

    def write(self, folder: Path, storage: StoragePlugin = StoragePlugin.SQLITE3) -> Path:
        """Write it as rosbag2 does."""
        return write_topics(folder, (self.scan, self.map, *self.others), storage)


def write_topics(folder: Path, topics: Sequence[Recorded], storage: StoragePlugin = StoragePlugin.SQLITE3) -> Path:
    """Write the folder of a bag, with messages in the order in which they came."""
    store = get_typestore(Stores.ROS2_JAZZY)
    with Writer2(folder, version=9, storage_plugin=storage) as writer:
        messages = []
        for each in topics:
            qos = [each.qos] if each.qos is not None else []
            connection = writer.add_connection(each.topic, each.message, typestore=store, offered_qos_profiles=qos)
            messages += [(time, connection, each.data) for time in each.times]
        for time, connection, data in sorted(messages, key=lambda item: item[0]):
            writer.write(connection, 10**18 + time * MS, data)
    return folder


def compare(folder: Path, bag: Path) -> ConformanceReport:
    checked_project = check_rover(folder / "rover", PROJECT)
    robot = observe_robot(bag, checked_project.root, ObservationOptions(distro="jazzy"))
    return hold_against_robots(checked_project, [robot], ComparedPart())


@pytest.mark.parametrize("storage", StoragePlugin)
def test_a_bag_as_designed_has_no_findings(tmp_path: Path, storage: StoragePlugin) -> None:
    """A topic of the design that was not recorded says nothing."""
    folder = Bag().write(tmp_path / "bag", storage)
    report = compare(tmp_path, folder)
    assert show_findings(report.reported.findings) == []
    comparison = report.comparisons[0]
    assert (comparison.topics, comparison.seen_topics) == (3, 2)
    scan = comparison.robot.topics[0]
    assert (scan.count, scan.duration, scan.longest_gap, scan.largest_size, scan.frames) == (
        100,
        9900 * MS,
        100 * MS,
        500,
        ("laser",),
    )
    assert scan.qos == {"reliability": "best_effort", "durability": "volatile"}
    file = next(each for each in folder.iterdir() if each.suffix in {".db3", ".mcap"})
    alone = observe_robot(file, tmp_path, ObservationOptions(distro="jazzy")).topics
    assert alone == comparison.robot.topics


SCAN = Bag().scan
FAULTS = {
    "rate": (
        Bag(scan=replace(SCAN, times=range(0, 10_000, 180))),
        "error rate-below-promise archgen.yaml:10 56 messages of `/scan` came at ~5.556 Hz, and 10 Hz are promised",
    ),
    "gap": (
        Bag(scan=replace(SCAN, times=[*range(0, 5000, 100), *range(5400, 10_000, 100)])),
        "error gap-above-promise archgen.yaml:10 between two of 96 messages of `/scan` lay 500 ms, and gaps of at most 200 ms are promised",
    ),
    "first message": (
        Bag(scan=replace(SCAN, times=range(1000, 10_000, 100))),
        "warning late-first-message archgen.yaml:10 the first message of `/scan` came 950 ms after the recording began, and gaps of at most 200 ms are promised",
    ),
    "size": (
        Bag(scan=replace(SCAN, data=make_scan(size=2000))),
        "warning larger-than-modelled archgen.yaml:4 a message of `/scan` had 2 kB, and 1 kB are in the model",
    ),
    "frame": (
        Bag(scan=replace(SCAN, data=make_scan("base_laser"))),
        "error other-frame archgen.yaml:10 messages of `/scan` are given in `base_laser`, and in `laser` in the design",
    ),
    "type": (
        Bag(scan=replace(SCAN, message="sensor_msgs/msg/PointCloud2")),
        "error other-type archgen.yaml:14 `/scan`, which `/lidar` publishes, has the type `sensor_msgs/msg/PointCloud2` on the robot, and `sensor_msgs/msg/LaserScan` in the design",
    ),
    "reliability": (
        Bag(scan=replace(SCAN, qos=make_qos("RELIABLE", "VOLATILE"))),
        "error other-qos archgen.yaml:14 the reliability of `/scan` is `reliable` on the robot, and `best_effort` in the design",
    ),
    "latched": (
        Bag(map=replace(Bag().map, qos=make_qos("RELIABLE", "VOLATILE"))),
        "error not-latched archgen.yaml:18 the durability of `/map` is `volatile` on the robot, and `transient_local` in the design",
    ),
    "stranger": (
        Bag(others=(Recorded("/debug", "std_msgs/msg/String", [60, 70], b"\0\1\0\0\1\0\0\0\0"),)),
        "warning not-in-model bag/metadata.yaml:70 `/debug` was recorded (2 messages), and the design has nobody who publishes it",
    ),
}


@pytest.mark.parametrize("name", FAULTS)
def test_a_planted_difference_is_found_and_no_other(tmp_path: Path, name: str) -> None:
    bag, expected = FAULTS[name]
    report = compare(tmp_path, bag.write(tmp_path / "rover/bag"))
    assert show_findings(report.reported.findings) == [expected]


def test_few_messages_are_no_rate(tmp_path: Path) -> None:
    bag = Bag(scan=replace(SCAN, times=[0, 150, 300]))
    assert show_findings(compare(tmp_path, bag.write(tmp_path / "bag")).reported.findings) == []


def test_metadata_alone_tells_types_offers_and_rates(tmp_path: Path) -> None:
    """The duration is that of the whole bag: a topic that began late comes out slower, so that it is no error."""
    bag = Bag(scan=replace(SCAN, times=range(0, 10_000, 180), qos=make_qos("RELIABLE", "VOLATILE"))).write(
        tmp_path / "bag"
    )
    (tmp_path / "alone").mkdir()
    (tmp_path / "alone/metadata.yaml").write_text((bag / "metadata.yaml").read_text(encoding="utf-8"), encoding="utf-8")
    shown = show_findings(compare(tmp_path, tmp_path / "alone").reported.findings)
    assert [each.split(" ")[:2] for each in shown] == [["warning", "rate-below-promise"], ["error", "other-qos"]]
    assert "over the whole recording, whenever it began" in shown[0]


def test_without_what_reads_messages_the_metadata_count(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, run: Run
) -> None:
    bag = Bag().write(tmp_path / "bag")
    check_rover(tmp_path / "rover", PROJECT)
    monkeypatch.setattr(bag_observation, "find_spec", lambda _: None)
    monkeypatch.chdir(tmp_path)
    done = run("conform", "rover", "--against", "bag")
    assert (done.status, done.out.splitlines()) == (
        0,
        [
            "bag (recording): 2 of 3 topics of the design; 101 messages of 2 topics",
            "  not read: the messages: gaps, sizes and frames are not known; `pip install 'archgen[recordings]'` installs what reads them",
            "no differences",
        ],
    )
    file = next(bag.glob("*.db3"))
    refused = run("conform", "rover", "--against", file)
    assert refused.status == 2
    assert "`pip install 'archgen[recordings]'` installs what reads them" in refused.err


def test_a_bag_of_ros_1(tmp_path: Path) -> None:
    store = get_typestore(Stores.ROS1_NOETIC)
    with Writer1(tmp_path / "old.bag") as writer:
        connection = writer.add_connection("/scan", "sensor_msgs/msg/LaserScan", typestore=store, latching=1)
        for number in range(20):
            writer.write(connection, number * 100 * MS, struct.pack("<IIII", number, 1, 2, 5) + b"laser" + b"\0" * 100)
    scan = observe_robot(tmp_path / "old.bag", tmp_path, ObservationOptions()).topics[0]
    assert (scan.message, scan.count, scan.frames, scan.qos) == (
        "sensor_msgs/msg/LaserScan",
        20,
        ("laser",),
        {"durability": "transient_local"},
    )


def test_broken_bags_are_refused_in_words(tmp_path: Path) -> None:
    bag = Bag().write(tmp_path / "bag")
    file = next(bag.glob("*.db3"))
    whole = file.read_bytes()
    (tmp_path / "cut.db3").write_bytes(whole[:5000])
    (tmp_path / "renamed.txt").write_bytes(whole)
    (tmp_path / "cut.mcap").write_bytes(b"\x89MCAP0\r\n" + b"\xff" * 40)
    (tmp_path / "metadata.yaml").write_text("rosbag2_bagfile_information:\n  version: 9\n", encoding="utf-8")
    for name, words in {
        "cut.db3": "it cannot be read as a bag",
        "cut.mcap": "it cannot be read as a bag",
        "renamed.txt": "it holds what files with the ending `.db3` hold",
        "metadata.yaml": "it is no metadata of a bag that lasted some time",
    }.items():
        with pytest.raises(ForeignFileError, match=words):
            observe_robot(tmp_path / name, tmp_path, ObservationOptions())


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="only Linux bounds the memory of a process")
@pytest.mark.parametrize("kind", try_some(["bag of ROS 1", "messages", "chunks"], 1))
def test_what_unpacks_to_very_much_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, kind: str) -> None:
    """A bag of some kB, of which a part is 300 MB once it is unpacked."""
    monkeypatch.setattr(ReadingLimits, "for_size", lambda _: ReadingLimits(60, 400_000_000, 10**9))
    data = bytes(300_000_000)
    if kind == "bag of ROS 1":
        path = tmp_path / "robot.bag"
        writer = Writer1(path)
        writer.set_compression(Writer1.CompressionFormat.LZ4)
        with writer:
            one = writer.add_connection("/a", "std_msgs/msg/String", typestore=get_typestore(Stores.ROS1_NOETIC))
            writer.write(one, 10**18, data)
    else:
        path = tmp_path / "bag"
        storage = StoragePlugin.MCAP if kind == "chunks" else StoragePlugin.SQLITE3
        mode = CompressionMode.STORAGE if kind == "chunks" else CompressionMode.MESSAGE
        other = Writer2(path, version=9, storage_plugin=storage)
        other.set_compression(mode, CompressionFormat.ZSTD)
        with other:
            two = other.add_connection("/a", "std_msgs/msg/String", typestore=get_typestore(Stores.ROS2_JAZZY))
            other.write(two, 10**18, data)
            other.write(two, 2 * 10**18, b"")
    del data
    assert sum(each.stat().st_size for each in [path, *tmp_path.rglob("*")] if each.is_file()) < 5_000_000
    with pytest.raises(ForeignFileError) as refused:
        observe_robot(path, tmp_path, ObservationOptions(distro="jazzy"))
    assert refused.value.message == "a part of it unpacks to more than 400 MB"


def test_what_is_read_without_an_end_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A table of a bag is a view here, in which SQLite counts for ever, deaf to Python's own signals."""
    monkeypatch.setattr(ReadingLimits, "for_size", lambda _: ReadingLimits(1, 900_000_000, 10**9))
    with closing(sqlite3.connect(tmp_path / "bag.db3")) as database:
        database.executescript(
            """
            CREATE TABLE schema(schema_version INTEGER);
            INSERT INTO schema VALUES (4);
            CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB);
            CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT,
                offered_qos_profiles TEXT, type_description_hash TEXT);
            CREATE VIEW message_definitions AS WITH RECURSIVE numbers(n) AS (SELECT 1 UNION ALL SELECT 1 FROM numbers)
                SELECT n AS id, '' AS topic_type, '' AS encoding, '' AS encoded_message_definition,
                '' AS type_description_hash FROM numbers WHERE n = 2;
            """
        )
    with pytest.raises(ForeignFileError, match="reading it takes more than 1 s of computing"):
        observe_robot(tmp_path / "bag.db3", tmp_path, ObservationOptions())


@pytest.mark.parametrize("mode", [CompressionMode.FILE, CompressionMode.MESSAGE])
def test_what_unpacks_to_many_times_its_size_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, mode: CompressionMode
) -> None:
    """Each message is small, and a file is refused before anything of it is written out (`copyfileobj`)."""
    writer = Writer2(tmp_path / "bag", version=9, storage_plugin=StoragePlugin.MCAP)
    writer.set_compression(mode, CompressionFormat.ZSTD)
    with writer:
        two = writer.add_connection("/a", "std_msgs/msg/String", typestore=get_typestore(Stores.ROS2_JAZZY))
        for number in range(30):
            writer.write(two, 10**18 + number, bytes(1_000_000))
    monkeypatch.setattr(shutil, "copyfileobj", None)
    with pytest.raises(ForeignFileError, match="it unpacks to more than 20 MB"):
        list(read_messages(tmp_path / "bag", "jazzy", ReadingLimits(60, 10**9, 20_000_000)))


def test_packed_files_are_read(tmp_path: Path) -> None:
    writer = Writer2(tmp_path / "bag", version=9)
    writer.set_compression(CompressionMode.FILE, CompressionFormat.ZSTD)
    with writer:
        two = writer.add_connection("/a", "std_msgs/msg/String", typestore=get_typestore(Stores.ROS2_JAZZY))
        for number in range(2):
            writer.write(two, 10**18 + number, bytes(1000))
    (tmp_path / "bag" / "other.zst").write_bytes(b"\x28\xb5\x2f\xfd broken, and no part of the bag")
    robot = observe_robot(tmp_path / "bag", tmp_path, ObservationOptions(distro="jazzy"))
    assert [(each.name, each.count) for each in robot.topics] == [("/a", 2)]


def test_metadata_that_name_a_file_twice_are_refused(tmp_path: Path) -> None:
    bag = Bag().write(tmp_path / "bag")
    metadata = bag / "metadata.yaml"
    text = metadata.read_text(encoding="utf-8")
    assert text.count("  - bag.db3\n") == 1
    metadata.write_text(text.replace("  - bag.db3\n", "  - bag.db3\n  - ./bag.db3\n"), encoding="utf-8")
    with pytest.raises(ForeignFileError, match=r"it names the file `bag\.db3` twice"):
        observe_robot(bag, tmp_path, ObservationOptions(distro="jazzy"))
