"""`archgen init`: start a project."""

from __future__ import annotations

from pathlib import Path

import click

from archgen.cli import run

SCHEMA = ".archgen/archgen.schema.json"

PROJECT = """\
# yaml-language-server: $schema={schema}
# A project is one mapping. It starts in this file and can be split over as many files as you like, by moving lines:
# every *.yaml below this folder is read. `archgen check` finds mistakes, `archgen build` makes report, site and diagrams.
archgen: 1
project: {{id: {name}, title: {title}}}
ros: {{distro: jazzy}}

groups:
  sensing:
    title: Sensing
    components:
      lidar:
        functionality: Measures the distance to what stands around the robot.
        role: source
        inputs:
          surroundings: {{external: "Walls, furniture and people", medium: physical}}
        outputs:
          scan: Laser scan
  driving:
    title: Driving
    components:
      obstacle_stop:
        functionality: Stops the robot before it touches anything.
        role: filter
        inputs:
          scan: lidar.scan            # a reference: the leading parts may be left out
        outputs:
          velocity: Velocity command  # a conceptual type, mapped to a ROS message by archgen or below `types`
      wheels:
        functionality: Turns the wheels as commanded.
        role: sink
        inputs:
          velocity: obstacle_stop.velocity
        outputs:
          motion: {{medium: physical, external: The robot moves}}

nodes:
  lidar_driver: {{implements: lidar, package: urg_node, kind: driver, status: existing}}
  obstacle_stop: {{implements: obstacle_stop, package: {name}_safety, status: planned}}
  wheel_controller: {{implements: wheels, package: diff_drive_controller, status: existing}}
"""


@click.command("init")
@click.argument("folder", required=False, type=click.Path(file_okay=False, path_type=Path))
@click.option("--title", help="The project's title.  [default: made from the folder's name]")
def command(folder: Path | None, title: str | None) -> None:
    """Start a project in FOLDER (the current one if left out): a small robot that checks clean, to be changed.

    The JSON Schema for editors goes beside it. No file is ever overwritten.
    """
    from archgen import resources
    from archgen.emit import tree, yaml

    target = folder or Path()
    name = _id(target.resolve().name)
    text = PROJECT.format(schema=SCHEMA, name=name, title=yaml.scalar(title or name.replace("_", " ").capitalize()))
    schema = resources.path("schemas", "archgen.schema.json").read_bytes()
    files = {"archgen.yaml": text.encode(), SCHEMA: schema}
    there = [file for file in files if (target / file).exists()]
    if "archgen.yaml" in there:
        msg = f"{target / 'archgen.yaml'} is there already; nothing was written"
        raise click.ClickException(msg)
    for file, data in files.items():
        if file not in there:
            with run.phrased():
                tree.write_file(target / file, data)
            click.echo(f"wrote {target / file}")
    click.echo("Now: archgen check, then archgen build.")


def _id(name: str) -> str:
    """Make an id of a folder's name."""
    words = "".join(c if c.isascii() and c.isalnum() else " " for c in name.lower()).split()
    made = "_".join(words)[:48].strip("_")
    return made if made[:1].isalpha() else f"robot_{made}".strip("_")
