"""What stands behind the ports of composed components that hold others."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen import pipeline

PLANT = """\
groups:
  g:
    components:
      reader: {inputs: {i: SOURCE}}
      outer:
        inputs: {a: {external: The world}}
        outputs: {x: {from: middle.x}, y: {from: leaf.y}}
        components:
          middle:
            inputs: {a: self.a}
            outputs: {x: {from: inner.x}}
            components:
              inner: {inputs: {a: self.a}, outputs: {x: {from: deep.x}}, components: {deep: {inputs: {a: self.a}, outputs: {x: T}}}}
          leaf: {outputs: {y: T}}
"""


@pytest.mark.parametrize(
    ("source", "outputs"),
    [
        ("outer.x", ["g.outer.middle.inner.deep.x"]),
        ("outer.y", ["g.outer.leaf.y"]),
    ],
)
def test_a_reader_of_a_composed_output_reads_the_leaf_behind_it(
    tmp_path: Path, source: str, outputs: list[str]
) -> None:
    (tmp_path / "robot.yaml").write_text(PLANT.replace("SOURCE", source), encoding="utf-8")
    architecture = pipeline.check_project(tmp_path / "robot.yaml").architecture
    (connection,) = (each for each in architecture.connections if each.input == "g.reader.i")
    assert sorted(connection.outputs) == outputs


def test_each_port_of_a_composed_component_says_what_stands_behind_it(tmp_path: Path) -> None:
    (tmp_path / "robot.yaml").write_text(PLANT.replace("SOURCE", "outer.y"), encoding="utf-8")
    architecture = pipeline.check_project(tmp_path / "robot.yaml").architecture
    assert architecture.shell_ports == {
        "input g.outer.a": ("g.outer.middle.a",),
        "input g.outer.middle.a": ("g.outer.middle.inner.a",),
        "input g.outer.middle.inner.a": ("g.outer.middle.inner.deep.a",),
        "output g.outer.x": ("g.outer.middle.x",),
        "output g.outer.y": ("g.outer.leaf.y",),
        "output g.outer.middle.x": ("g.outer.middle.inner.x",),
        "output g.outer.middle.inner.x": ("g.outer.middle.inner.deep.x",),
    }


def test_an_input_that_several_outputs_fit_counts_as_written_and_another_does_not(tmp_path: Path) -> None:
    file = tmp_path / "robot.yaml"
    file.write_text(
        """\
groups:
  g:
    autoconnect: ports
    components:
      left: {outputs: {image: Image}}
      right: {outputs: {image: Image}}
      eye: {inputs: {image: {type: Image}, light: {type: Image}}}
""",
        encoding="utf-8",
    )
    ports = pipeline.check_project(file).architecture.inputs
    assert ports["g.eye.image"].from_written  # so that it is not reported a second time, as one without a source
    assert not ports["g.eye.light"].from_written
