"""Tables of what is used together, of resources, and of measured execution times."""

from __future__ import annotations

from archgen.views.lookup import Lookup, make_lookup
from archgen.views.shapes import Table
from archgen.views.timing import use_tables
from archgen.views.timing.timing_lookup import TimingLookup, analyse_with_chains
from tests.timing.random_systems import architecture

_TEXT = """
groups:
  g:
    components:
      cam: {outputs: {image: sensor_msgs/msg/Image}}
      lidar: {outputs: {cloud: sensor_msgs/msg/PointCloud2}}
      fuse: {inputs: {image: cam.image, cloud: lidar.cloud}}
nodes:
  cam: {implements: cam, timing: {period: 30 ms, wcet: {max: 0 ms, p50: 0 ms, measured: true}}}
  lidar: {implements: lidar, timing: {period: 100 ms, wcet: 0 ms}}
  fuse: {implements: fuse, host: pc, timing: {trigger: {match: [image, cloud], within: 40 ms}, wcet: 5 ms, uses: {gpu: 12 ms}}}
hosts: {pc: {cores: 1}}
links: {}
resources: {gpu: {host: pc}}
"""


def test_what_is_used_together() -> None:
    """No link joins what has no host with `pc`: then ages are not known, how far apart is."""
    lookup, timing_lookup = _views(_TEXT)
    assert _rows(use_tables.make_fused_table(lookup, timing_lookup)) == [
        ["fuse", "what is at most 40 ms apart", "40 ms", "image unknown, cloud unknown"]
    ]
    near = _TEXT.replace("implements: cam,", "implements: cam, host: pc,").replace(
        "implements: lidar,", "implements: lidar, host: pc,"
    )
    (row,) = _rows(use_tables.make_fused_table(*_views(near)))
    assert row[3].startswith("image 1")


def test_a_resource_has_its_load_and_its_users() -> None:
    assert _rows(use_tables.make_resource_table(*_views(_TEXT))) == [["gpu", "pc", "<= 12 %", "bearable", "fuse 12 ms"]]


def test_measured_times_say_that_nothing_rests_on_percentiles() -> None:
    assert _rows(use_tables.make_measured_table(*_views(_TEXT))) == [
        ["cam", "p50 0 ms", "0 ms", "longest seen, not proven"]
    ]


def test_without_any_of_it_there_are_no_tables() -> None:
    views = _views("groups: {g: {components: {a: {}}}}\nnodes: {a: {implements: a, timing: {period: 10 ms}}}")
    assert use_tables.make_fused_table(*views) is None
    assert use_tables.make_resource_table(*views) is None
    assert use_tables.make_measured_table(*views) is None


def _views(text: str) -> tuple[Lookup, TimingLookup]:
    model = architecture(text)
    timing_lookup = analyse_with_chains(model)
    return make_lookup(model, timing_lookup=timing_lookup), timing_lookup


def _rows(table: Table | None) -> list[list[str]]:
    assert table is not None
    return [["".join(part.text for part in cell) for cell in row] for row in table.rows]
