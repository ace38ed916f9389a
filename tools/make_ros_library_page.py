"""Write docs/ros_library.md: the component types that ship with archgen. The data in ros_library/ is the source."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

from archgen.link import mapping_values
from archgen.model.known_interfaces import KNOWN_DISTROS
from archgen.project.shipped_library import load_shipped_types
from archgen.syntax.yaml_tree import MappingNode

PAGE = Path(__file__).resolve().parent.parent / "docs" / "ros_library.md"
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

Which types there are depends on the project's distribution. Their ports have messages as types, so that they fit whatever a project calls
its data; topics are those of the package. Parameters are the main ones, with the values that the node itself starts with; any other is
accepted. `archgen list --of component_types --library builtin` lists them for a project, `archgen new instance ID ros.TYPE` writes an
instance with its inputs to be filled. A type that does not fit is changed as any other: `my_slam: {is: ros.slam_toolbox, ...}` below
`component_types` may add ports and parameters.

An input with `?` is optional. Where distributions differ, a type stands here once for each form.
"""


def format_page() -> str:
    """Return the page's text."""
    rows: dict[tuple[str, ...], list[str]] = {}
    for distro in KNOWN_DISTROS:
        for name, entry in load_shipped_types(distro).items():
            rows.setdefault(_format_row(name, mapping_values.get_body(entry)), []).append(distro)
    lines = [
        OPENING,
        "| type | what it does | inputs | outputs | package | distributions |",
        "|---|---|---|---|---|---|",
    ]
    for row, distros in sorted(rows.items()):
        lines.append(f"| {' | '.join((*row, ', '.join(sorted(distros, key=_ORDER.index))))} |")
    return "\n".join(lines) + "\n"


_ORDER = ("noetic", "humble", "jazzy", "kilted", "lyrical", "rolling")


def _format_row(name: str, body: MappingNode) -> tuple[str, ...]:
    node = mapping_values.get_mapping(body, "node")
    package, executable = (mapping_values.get_text(node, key) for key in ("package", "executable"))
    return (
        f"`{name}`",
        mapping_values.get_text(body, "functionality") or "",
        "<br>".join(_list_ports(body, "inputs")),
        "<br>".join(_list_ports(body, "outputs")),
        f"{package}, `{executable}`" if executable else package or "",
    )


def _list_ports(body: MappingNode, side: str) -> Iterator[str]:
    for name, _, port in mapping_values.iterate_elements(body, side):
        mark = "?" if mapping_values.get_flag(port, "optional") else ""
        message = (mapping_values.get_text(port, "type") or "").replace("/msg/", "/")
        yield f"`{name}`{mark} {message}".strip()


def main() -> int:
    """Write the page."""
    PAGE.write_text(format_page(), encoding="utf-8", newline="\n")
    print(PAGE)
    return 0


if __name__ == "__main__":
    sys.exit(main())
