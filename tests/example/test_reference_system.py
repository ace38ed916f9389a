"""The reference system against the figures that follow from its published graph."""

from __future__ import annotations

from collections import Counter
from fractions import Fraction
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.model.architecture import Architecture
from archgen.timing.analysis import Analysis
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.run_analysis import analyse_architecture
from archgen.timing.system import message_sizes

FOLDER = Path(__file__).parents[2] / "examples" / "reference_system"
READERS = {
    "FrontLidarDriver": {"PointsTransformerFront"},
    "RearLidarDriver": {"PointsTransformerRear"},
    "PointCloudMap": {"PointCloudMapLoader"},
    "Visualizer": {"Lanelet2GlobalPlanner"},
    "Lanelet2Map": {"Lanelet2MapLoader"},
    "EuclideanClusterSettings": {"EuclideanClusterDetector"},
    "PointsTransformerFront": {"PointCloudFusion"},
    "PointsTransformerRear": {"PointCloudFusion"},
    "VoxelGridDownsampler": {"NDTLocalizer"},
    "PointCloudMapLoader": {"NDTLocalizer"},
    "RayGroundFilter": {"EuclideanClusterDetector"},
    "ObjectCollisionEstimator": {"BehaviorPlanner"},
    "MPCController": {"VehicleInterface"},
    "ParkingPlanner": {"BehaviorPlanner"},
    "LanePlanner": {"BehaviorPlanner"},
    "PointCloudFusion": {"VoxelGridDownsampler", "RayGroundFilter"},
    "NDTLocalizer": {"Lanelet2GlobalPlanner", "BehaviorPlanner"},
    "VehicleInterface": {"VehicleDBWSystem"},
    "Lanelet2GlobalPlanner": {"Lanelet2MapLoader", "BehaviorPlanner"},
    "Lanelet2MapLoader": {"ParkingPlanner", "LanePlanner", "BehaviorPlanner"},
    "BehaviorPlanner": {"MPCController", "VehicleInterface"},
    "EuclideanClusterDetector": {"ObjectCollisionEstimator"},
    "EuclideanIntersection": {"IntersectionOutput"},
}
"""Every topic with the nodes that read it, as published."""


@pytest.fixture(scope="module")
def checked() -> pipeline.CheckedProject:
    return pipeline.check_project(FOLDER)


@pytest.fixture(scope="module")
def architecture(checked: pipeline.CheckedProject) -> Architecture:
    return checked.architecture


def test_it_checks_clean(checked: pipeline.CheckedProject) -> None:
    assert [f"{f.rule} {f.span}" for f in checked.findings] == []


def test_the_graph_is_the_published_one(architecture: Architecture) -> None:
    names = {node.id: node.name for node in architecture.nodes.values()}
    read = {topic.name.strip("/"): {names[end.node] for end in topic.readers} for topic in architecture.topics.values()}
    assert read == READERS
    for topic in architecture.topics.values():
        writer = "EuclideanClusterDetector" if topic.name == "/EuclideanIntersection" else topic.name.strip("/")
        assert [names[end.node] for end in topic.writers] == [writer]


def test_its_counts(architecture: Architecture) -> None:
    uses = Counter(end.use for end in architecture.endpoints)
    assert len(architecture.nodes) == 24
    assert sum(len(node.timing) for node in architecture.nodes.values()) == 25
    assert len(architecture.topics) == 23
    assert uses == {"publishes": 23, "subscribes": 29}


def test_queues_hold_one_sample_but_for_the_ends(architecture: Architecture) -> None:
    names = {node.id: node.name for node in architecture.nodes.values()}
    depths = {(names[end.node], end.qos.depth) for end in architecture.endpoints if end.use == "subscribes"}
    assert {name for name, depth in depths if depth != 1} == {"VehicleDBWSystem", "IntersectionOutput"}
    assert {depth for _, depth in depths} == {1, 10}


def test_the_message_has_4096_bytes_and_4_in_front(architecture: Architecture) -> None:
    query = message_sizes.make_size_query(architecture)
    assert query("reference_interfaces/msg/Message4kb", None).bytes == 4096 + 4
    assert message_sizes.make_byte_query(architecture)("reference_interfaces/msg/Message4kb", "Sample") == 4096


@pytest.fixture(scope="module")
def analysis(architecture: Architecture) -> Analysis:
    return analyse_architecture(architecture)


def test_rates(analysis: Analysis) -> None:
    by_rate = {
        Fraction(25, 3): {
            "point_cloud_map",
            "point_cloud_map_loader",
            "ndt_localizer",
            "lanelet2_global_planner",
            "lanelet2_map_loader",
            "parking_planner",
            "lane_planner",
        },
        Fraction(50, 3): {"visualizer"},
        Fraction(40): {
            "euclidean_cluster_settings",
            "euclidean_cluster_detector.intersection",
            "intersection_output",
        },
    }
    wanted = {name: rate for rate, names in by_rate.items() for name in names}
    assert len(analysis.paces) == 25
    assert {name: pace.rate.value for name, pace in analysis.paces.items()} == {
        name: wanted.get(name, Fraction(10)) for name in analysis.paces
    }


def test_traffic(analysis: Analysis) -> None:
    assert sum(topic.published.value or 0 for topic in analysis.topics.values()) == 1_167_360
    assert sum(topic.delivered.value or 0 for topic in analysis.topics.values()) == Fraction(4_157_440, 3)


def test_processor_cores_in_use(analysis: Analysis) -> None:
    tick, second = analysis.system.tick, 10**9
    used = Fraction(0)
    for name, activity in analysis.system.activities.items():
        rate = analysis.paces[name].rate.value
        assert rate is not None
        assert activity.wcet is not None
        used += rate * activity.wcet * tick / second
    assert used == Fraction(19, 10)


@pytest.mark.parametrize("name", ["hot_path_front", "hot_path_rear"])
def test_the_hot_path(architecture: Architecture, analysis: Analysis, name: str) -> None:
    ms = Fraction(10**6)
    found = bound_all_chains(analysis, architecture)[name]
    assert (found.best.value, found.bound.value) == (50 * ms, 260 * ms)
    assert found.bound.complete
    assert [(term.sampling.value, term.response.value) for term in found.terms] == [
        (100 * ms, 0 * ms),
        (0 * ms, 10 * ms),
        (100 * ms, 10 * ms),
        (0 * ms, 10 * ms),
        # One thread for the two halves of the detector.
        (0 * ms, 20 * ms),
        (0 * ms, 10 * ms),
    ]
