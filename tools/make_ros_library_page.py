"""Write docs/ros_library.md from ros_library/: the component types that ship."""

from __future__ import annotations

import sys
from collections.abc import Callable, Collection, Mapping
from pathlib import Path

from archgen.link import mapping_values
from archgen.project.library_reading import load_shipped_component_types
from archgen.syntax.yaml_tree import MappingNode

Form = tuple[tuple[str, ...], ...]
"""What a type is in a distribution: what it does, and its package."""

DOCS = Path(__file__).resolve().parent.parent / "docs"
OPENING = """\
# The library of ROS packages that ships with archgen

Made by `tools/make_ros_library_page.py` from the data in `ros_library/`.

```yaml
# archgen.yaml
ros: {distro: jazzy}
libraries: {ros: builtin}
```
```yaml
groups:
  mapping:
    components:
      lidar: {is: ros.rplidar}
      slam: {is: ros.slam_toolbox, inputs: {scan: lidar.scan}}
```

| command | shows |
|---|---|
| `archgen list --of component_types --library builtin` | the types of the project's distribution, with their inputs and outputs |
| `archgen new instance ID ros.TYPE` | writes an instance, with its inputs to be filled |
| `archgen show ID` | an instance: ports, parameters, operations, and its node |
| `archgen explain ros.amcl --distro jazzy` | where each executable, plug-in, name, port, operation and parameter was read: repository, version, commit, file and line |

Ports have messages as types, so they fit whatever a project calls its data; topics are those of the package. Where a parameter names a
topic, its value counts: a filter whose `odom0` is `odom/unfiltered` reads that topic, and has no input `odom1` on the robot where nobody
gives that parameter. Parameters are the main ones, with the values that the node starts with; any other is accepted. A type that does not
fit is changed as any other: `my_slam: {is: ros.slam_toolbox, ...}` below `component_types` may add ports and parameters.

All types have `status: existing`: `archgen generate` makes none of their packages (what has a `package` of your own is made, unless its
`status` says that it exists), and [asks](rules/shadowed-package.md) about other nodes that have one of these. A node that runs one of these
programs without its type (`package`, and `executable` or `plugin`) is [told](rules/unlike-program.md) where the program's names are not the
design's, and nothing remaps them.

Every port with its message and topic is in YAML in [ros_library](../ros_library). What was not found in the packages' sources is not
there.
"""


def format_page() -> str:
    """Return the text of the page of all types."""
    forms: dict[str, dict[str, Form]] = {}
    for distro in _ORDER:
        for name, entry in load_shipped_component_types(distro).items():
            forms.setdefault(name, {})[distro] = _describe_form(mapping_values.get_body(entry))
    lines = [
        OPENING,
        "| type | what it does | package | distributions |",
        "|---|---|---|---|",
    ]
    for name, form_by_distro in sorted(forms.items()):
        columns = [_merge_column(column, form_by_distro) for column in range(2)]
        lines.append(f"| `{name}` | {' | '.join(columns)} | {_name_distros(form_by_distro)} |")
    return "\n".join(lines) + "\n"


def _merge_column(column: int, form_by_distro: Mapping[str, Form]) -> str:
    """Return what a type has in a column, and behind what it has not in all of its distributions where it has it."""
    distros_by_line: dict[str, list[str]] = {}
    for distro, form in reversed(tuple(form_by_distro.items())):  # the newest first
        for line in form[column]:
            distros_by_line.setdefault(line, []).append(distro)
    return "<br>".join(
        line if len(distros) == len(form_by_distro) else f"{line} ({_name_distros(distros)})"
        for line, distros in distros_by_line.items()
    )


def _name_distros(distros: Collection[str]) -> str:
    """Return distributions in their order; of three or more that follow one another the first and the last one."""
    places = sorted(map(_ORDER.index, distros))
    if len(places) == len(_ORDER):
        return "all"
    if len(places) not in {1, 2} and places[-1] - places[0] == len(places) - 1:
        return f"{_ORDER[places[0]]} to {_ORDER[places[-1]]}"
    return ", ".join(_ORDER[place] for place in places)


_ORDER = ("noetic", "humble", "jazzy", "kilted", "lyrical", "rolling")


def _describe_form(body: MappingNode) -> Form:
    package = mapping_values.get_text(mapping_values.get_mapping(body, "node"), "package")
    return (mapping_values.get_text(body, "functionality") or "",), (package or "",)


PAGES: dict[Path, Callable[[], str]] = {
    DOCS / "ros_library.md": format_page,
}


def main() -> int:
    """Write the pages."""
    for page, format_text in PAGES.items():
        page.write_text(format_text(), encoding="utf-8", newline="\n")
        print(page)
    return 0


if __name__ == "__main__":
    sys.exit(main())
