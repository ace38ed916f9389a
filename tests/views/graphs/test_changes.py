"""Pictures of what changed between two versions."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.compare import Comparison
from archgen.compare.select_changes import select_changes
from archgen.emit import graphviz
from archgen.emit.markdown.mermaid_chart import write_flowchart
from archgen.model.selector_evaluation import SelectorEvaluator
from archgen.products.compared_versions import ProjectVersion, compare_named_versions
from archgen.views.graphs.changes import LARGE_BUDGET, SMALL_BUDGET, draw_changes
from archgen.views.picture_shapes import Arrow, Box, Graph

ROBOT = """\
archgen: 1
project: {id: robot}
partners: {certh: CERTH, sssa: SSSA}
groups:
  sensing:
    owner: certh
    components:
      camera: {outputs: {image: Image}}
      lidar: {outputs: {scan: Scan}}
  display:
    owner: sssa
    components:
      finder: {inputs: {image: camera.image}, outputs: {people: People}}
      map: {inputs: {scan: lidar.scan}, outputs: {grid: Grid}}
      screen: {inputs: {people: finder.people, grid: map.grid}}
types: {Image: sensor_msgs/msg/Image, Scan: sensor_msgs/msg/LaserScan, People: geometry_msgs/msg/PoseArray, Grid: nav_msgs/msg/OccupancyGrid}
nodes:
  camera: {implements: camera, publishes: {image: {topic: /image, qos: {reliability: reliable}}}}
  lidar: {implements: lidar}
  finder: {implements: finder, subscribes: {image: {}}}
  map: {implements: map}
  screen: {implements: screen}
"""
Compared = Callable[..., Comparison]


@pytest.fixture
def found(tmp_path: Path) -> Compared:
    """Compare ROBOT with what changes make of it."""

    def run(*changes: tuple[str, str]) -> Comparison:
        after = ROBOT
        for old, new in changes:
            assert old in after
            after = after.replace(old, new)
        sides = []
        for name, text in (("before", ROBOT), ("after", after)):
            (tmp_path / name).mkdir(exist_ok=True)
            (tmp_path / name / "robot.yaml").write_text(text, encoding="utf-8")
            sides.append(ProjectVersion(name, pipeline.check_project(tmp_path / name / "robot.yaml")))
        return compare_named_versions(*sides)

    return run


def boxes(graph: Graph) -> list[str]:
    """Name each box with its frame, what happened to it, and whether it is grey."""
    return [_box(box) for box in graph.boxes]


def _box(box: Box) -> str:
    return f"{box.cluster}: {box.title}" + (
        f" ({box.change})" if box.change else " (grey)" if box.emphasis == "neighbour" else ""
    )


def lines(graph: Graph) -> list[str]:
    """Name each arrow with its text."""
    return [_arrow(arrow) for arrow in graph.arrows]


def _arrow(arrow: Arrow) -> str:
    return f"{arrow.tail} > {arrow.head}" + (f" {arrow.label} ({arrow.change})" if arrow.change else "")


def test_a_component_inside_of_another_says_in_which(tmp_path: Path) -> None:
    text = """archgen: 1
component_types: {eye: {components: {finder: {outputs: {o: std_msgs/msg/Empty}, timing: {rate: 10 Hz}}}}}
groups: {g: {components: {left: {is: eye}, right: {is: eye}}}}
"""
    sides = []
    for name, content in (("before", text), ("after", text.replace("10 Hz", "20 Hz"))):
        (tmp_path / name).mkdir()
        (tmp_path / name / "robot.yaml").write_text(content, encoding="utf-8")
        sides.append(ProjectVersion(name, pipeline.check_project(tmp_path / name / "robot.yaml")))
    components = draw_changes(compare_named_versions(*sides))[0]
    assert [(box.title, box.lines) for box in components.boxes] == [
        ("~ Finder", ("Left",)),
        ("~ Finder", ("Right",)),
    ]


def test_added_removed_and_changed_stand_in_one_picture(found: Compared) -> None:
    change = found(
        ("      lidar: {outputs: {scan: Scan}}\n", "      radar: {outputs: {tracks: People}}\n"),
        ("lidar.scan", "radar.tracks"),
        ("  lidar: {implements: lidar}", "  radar: {implements: radar, timing: {rate: 10 Hz}}"),
        ("Image: sensor_msgs/msg/Image", "Image: sensor_msgs/msg/CompressedImage"),
    )
    components, nodes = draw_changes(change)
    assert boxes(components) == [
        "sensing: Camera (grey)",
        "sensing: + Radar (added)",
        "sensing: \u2212 Lidar (removed)",
        "display: ! Finder",
        "display: ! Map",
    ]
    assert lines(components) == [
        "sensing.camera > display.finder ! Image (changed)",
        "sensing.radar > display.map + People (added)",
        "sensing.lidar > display.map ! Scan (removed)",
    ]
    # What breaks another partner is marked, with whose it is.
    assert [arrow.broken for arrow in components.arrows] == [True, False, True]
    assert [(box.broken, box.lines) for box in components.boxes[3:]] == [(True, ("breaks SSSA",))] * 2
    assert components.notes == ("1 unchanged neighbour not drawn.",)
    radar = components.boxes[1]
    assert radar.tooltip.startswith("component `sensing.radar` is added with 1 output\nRadar (sensing.radar)")
    assert "line:broken" in components.legend
    assert "change:removed" in components.legend
    assert "None: + radar (added)" in boxes(nodes)
    assert "None: \u2212 lidar (removed)" in boxes(nodes)


def test_ports_without_a_connection_are_named_in_the_box(found: Compared) -> None:
    (graph,) = draw_changes(
        found(
            ("outputs: {grid: Grid}", "outputs: {grid: Grid, cost: Grid}"),
            ("inputs: {image: camera.image}", "inputs: {scan: lidar.scan}"),
        )
    )[:1]
    lines = {box.title: box.lines for box in graph.boxes}
    assert lines["~ Map"] == ("+ output cost",)
    # The arrows show that it reads something else now.
    assert lines["~ Finder"] == ()


def test_a_rename_is_no_removal(found: Compared) -> None:
    (components,) = draw_changes(
        found(
            ("finder: {inputs", "seeker: {inputs"),
            ("finder.people", "seeker.people"),
            ("finder: {implements: finder", "finder: {implements: seeker"),
        )
    )
    assert boxes(components) == ["display: → Seeker (renamed)", "display: Screen (grey)", "None: Camera (grey)"]
    assert lines(components) == ["<sensing > display.seeker", "display.seeker > display.screen"]


def test_groups_in_which_nothing_changed_are_one_box_without_a_frame(tmp_path: Path) -> None:
    text = """archgen: 1
groups:
  near: {title: Near, components: {core: {inputs: {a: e1.o, b: e2.o, c: far.o}, outputs: {o: T}}}}
  eyes:
    title: Eyes
    components:
      e1: {title: Left eye, outputs: {o: T}, inputs: {back: core.o}}
      e2: {title: Right eye, outputs: {o: T}}
  distant: {title: Distant, components: {far: {title: Far, outputs: {o: T}}, new: {title: Reader}}}
"""
    changed = text.replace("components: {core: {", "components: {core: {timing: {rate: 5 Hz}, ").replace(
        "{title: Reader}", "{title: Reader, inputs: {x: e2.o}}"
    )
    sides = []
    for name, content in (("before", text), ("after", changed)):
        (tmp_path / name).mkdir()
        (tmp_path / name / "robot.yaml").write_text(content, encoding="utf-8")
        sides.append(ProjectVersion(name, pipeline.check_project(tmp_path / name / "robot.yaml")))
    (graph, *_) = draw_changes(compare_named_versions(*sides))
    assert [cluster.id for cluster in graph.clusters] == ["near", "distant"]
    drawn = {box.id: (box.cluster, box.title, box.lines) for box in graph.boxes}
    assert drawn == {
        "near.core": ("near", "~ Core", ()),
        # A changed connection leaves here, so it keeps a box of its own.
        "eyes.e2": (None, "Right eye", ("Eyes",)),
        "distant.far": ("distant", "Far", ()),
        "distant.new": ("distant", "~ Reader", ()),
        # It feeds what changed and reads from it: a box at either end, and no arrow runs back.
        "<eyes": (None, "Left eye", ("Eyes",)),
        ">eyes": (None, "Left eye", ("Eyes",)),
    }
    assert lines(graph) == [
        "<eyes > near.core",
        "eyes.e2 > near.core",
        "distant.far > near.core",
        "near.core > >eyes",
        "eyes.e2 > distant.new + T (added)",
    ]
    assert graph.asked == 5


def test_quality_of_service_is_drawn_among_nodes(found: Compared) -> None:
    (nodes,) = draw_changes(found(("reliability: reliable", "reliability: best_effort")))
    assert boxes(nodes) == ["None: ~ camera (changed)", "None: finder (grey)", "None: /image"]
    assert lines(nodes) == ["node camera > topic /image ~ publishes (changed)", "topic /image > node finder"]
    assert "QoS reliability `reliable` → `best_effort`" in nodes.arrows[0].flows[0]


@pytest.mark.parametrize(
    "change",
    [
        ("project: {id: robot}", "project: {id: robot, title: Car}"),
        ("screen: {inputs", "screen: {description: Shows., inputs"),
    ],
)
def test_texts_are_not_drawn(found: Compared, change: tuple[str, str]) -> None:
    assert draw_changes(found(change)) == ()


def test_a_selection_draws_nothing_else(found: Compared) -> None:
    change = found(
        ("inputs: {image: camera.image}", "inputs: {scan: lidar.scan}"),
        ("{people: finder.people, grid: map.grid}", "{grid: map.grid}"),
        ("subscribes: {image: {}}", "package: p"),
    )
    sides = [SelectorEvaluator(side.architecture).evaluate("screen")[0] for side in (change.before, change.after)]
    whole, part = draw_changes(change)[0], draw_changes(select_changes(change, *sides))[0]
    assert "sensing.camera > display.finder \u2212 Image (removed)" in lines(whole)
    assert lines(part) == ["display.map > display.screen", "display.finder > display.screen \u2212 People (removed)"]


def test_above_its_budget_groups_are_folded_and_the_picture_says_so(found: Compared) -> None:
    many = "".join(f"      part{at}: {{inputs: {{image: camera.image}}}}\n" for at in range(60))
    change = found(("      finder:", f"{many}      finder:"))
    for budget in (SMALL_BUDGET, LARGE_BUDGET):
        (components,) = draw_changes(change, budget)
        assert boxes(components) == ["None: Camera (grey)", "None: Display (added)"]
        assert components.boxes[1].lines == ("+ 60 components",)
        assert lines(components) == ["sensing.camera > group display + 60 connections (added)"]
        assert components.notes[-1] == "1 group folded to one box each, because the picture would be too large."
        assert sum(arrow.count for arrow in components.arrows) == components.asked == 60


def test_lines_tell_what_happened_without_colour(found: Compared) -> None:
    change = found(
        ("      lidar: {outputs: {scan: Scan}}\n", "      radar: {outputs: {tracks: People}}\n"),
        ("lidar.scan", "radar.tracks"),
        ("  lidar: {implements: lidar}\n", ""),
        ("finder: {implements: finder,", "finder: {implements: finder, timing: {rate: 5 Hz},"),
    )
    (graph, *_) = draw_changes(change)
    svg = graphviz.draw_pictures((graph,), ("svg",), resolve_link=lambda _: None)[graph.id].svg
    assert svg is not None
    parts = svg.decode().replace("&#45;", "-").split("<g id=")
    added, removed, changed = (
        next(part for part in parts if f"change-{kind}" in part and "node" in part)
        for kind in ("added", "removed", "changed")
    )
    assert 'stroke-width="2.6"' in added
    assert "stroke-dasharray" in removed
    assert changed.count("<path") == 2
    assert [sign for sign in ("+ Radar", "\u2212 Lidar", "~ Finder") if f">{sign}<" in svg.decode()] == [
        "+ Radar",
        "\u2212 Lidar",
        "~ Finder",
    ]
    assert "component `sensing.radar` is added" in added


def test_mermaid_knows_boxes_by_number_only(found: Compared) -> None:
    (graph, *_) = draw_changes(
        found(("      lidar: {", "      extra: {title: '1. end \"]', outputs: {x: Image}}\n      lidar: {")),
        SMALL_BUDGET,
    )
    text = list(write_flowchart(graph))
    assert text[:3] == ["flowchart LR", '  subgraph g0["Sensing"]', '    n0("#8203;+ 1. end #34;#93;"):::added']
