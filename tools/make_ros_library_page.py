"""Write docs/ros_library.md from ros_library/: the component types that ship."""

from __future__ import annotations

import sys
from collections.abc import Callable, Collection, Iterator, Mapping
from pathlib import Path

from shipped_facts import list_type_facts

from archgen.link import mapping_values
from archgen.project.library_reading import load_shipped_component_types
from archgen.project.shipped_sources import read_shipped_sources
from archgen.syntax.yaml_tree import MappingNode

Form = tuple[tuple[str, ...], ...]
"""What a type is in a distribution: the lines of the columns between its name and its distributions."""

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

Which types there are depends on the project's distribution. Their ports have messages as types, so that they fit whatever a project calls
its data; topics are those of the package. Parameters are the main ones, with the values that the node itself starts with; any other is
accepted. `archgen list --of component_types --library builtin` lists them for a project, `archgen new instance ID ros.TYPE` writes an
instance with its inputs to be filled. A type that does not fit is changed as any other: `my_slam: {is: ros.slam_toolbox, ...}` below
`component_types` may add ports and parameters. A node that runs one of these programs without its type (`package`, and `executable` or
`plugin`) is [told](rules/unlike-program.md) where the program's names are not the design's, and nothing remaps them. All of them exist (`status: existing`): `archgen generate` makes none of their
packages (what has a `package` of your own is made, unless its `status` says that it exists), and
[asks](rules/shadowed-package.md) about other nodes that have one of these.

An input with `?` is optional. Behind a port stands what the program calls it, where that is another name, and `by` the parameter that names
it: a filter whose `odom0` is `odom/unfiltered` reads that topic, and has no input `odom1` on the robot where nobody gives that parameter.
`package` has the executable and the plug-in of a component, `node` is what the program calls its node where a launch file gives no name.
Where distributions differ, those stand in brackets in which it is so.

Each executable, plug-in, name, port, operation and parameter was read at a line of a file of the package, which `archgen explain ros.amcl`
shows: repository, version, commit, file and line (`ros_library/sources/` holds them). What was not found is not here. How many there are:
"""


def format_page() -> str:
    """Return the text of the page of all types."""
    forms: dict[str, dict[str, Form]] = {}
    for distro in _ORDER:
        for name, entry in load_shipped_component_types(distro).items():
            forms.setdefault(name, {})[distro] = _describe_form(mapping_values.get_body(entry))
    lines = [
        OPENING,
        *_list_counts(),
        "",
        "| type | what it does | inputs | outputs | package | node | distributions |",
        "|---|---|---|---|---|---|---|",
    ]
    for name, form_by_distro in sorted(forms.items()):
        columns = [_merge_column(column, form_by_distro) for column in range(5)]
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
    if len(places) not in {1, 2} and places[-1] - places[0] == len(places) - 1:
        return f"{_ORDER[places[0]]} to {_ORDER[places[-1]]}"
    return ", ".join(_ORDER[place] for place in places)


def _list_counts() -> Iterator[str]:
    yield "| distribution | types | facts | types read at the released version |"
    yield "|---|---|---|---|"
    for distro in _ORDER:
        types, sources = load_shipped_component_types(distro), read_shipped_sources(distro)
        facts = sum(len(list(list_type_facts(mapping_values.get_body(entry)))) for entry in types.values())
        fresh_types = [name for name in types if all(source.version == source.released for source in sources[name])]
        yield f"| {distro} | {len(types)} | {facts} | {len(fresh_types)} |"


_ORDER = ("noetic", "humble", "jazzy", "kilted", "lyrical", "rolling")


def _describe_form(body: MappingNode) -> Form:
    node = mapping_values.get_mapping(body, "node")
    package, executable = (mapping_values.get_text(node, key) for key in ("package", "executable"))
    plugin, own_name = (mapping_values.get_text(node, key) for key in ("plugin", "own_name"))
    programs = (f"{package}, `{executable}`" if executable else package or "", f"`{plugin}`" if plugin else "")
    return (
        (mapping_values.get_text(body, "functionality") or "",),
        tuple(_list_ports(body, "inputs")),
        tuple(_list_ports(body, "outputs")),
        tuple(filter(None, programs)),
        (f"`{own_name}`",) if own_name else (),
    )


def _list_ports(body: MappingNode, side: str) -> Iterator[str]:
    node = mapping_values.get_mapping(body, "node")
    uses = {
        key: use
        for section in (("subscribes", "calls") if side == "inputs" else ("publishes", "serves"))
        for key, _, use in mapping_values.iterate_elements(node, section)
    }
    for name, _, port in mapping_values.iterate_elements(body, side):
        mark = "?" if mapping_values.get_flag(port, "optional") else ""
        message = (mapping_values.get_text(port, "type") or "").replace("/msg/", "/")
        use = uses.get(name, mapping_values.EMPTY_MAPPING)
        topic = next((text for key in ("own_name", "topic", "name") for text in mapping_values.get_texts(use, key)), "")
        parameter = mapping_values.get_text(use, "named_by")
        words = [f"`{topic}`"] if topic not in {"", name} else []
        yield (
            " ".join([f"`{name}`{mark}", message, *words, *([f"by `{parameter}`"] if parameter else [])])
            .replace("  ", " ")
            .strip()
        )


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
