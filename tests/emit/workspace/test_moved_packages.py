"""Own code that was moved to another package names what is beside it by the old one: told, with the new one."""

from __future__ import annotations

import pytest

from archgen.emit.workspace.disk_files import GeneratedFile
from archgen.emit.workspace.workspace_plan import find_moved_packages
from archgen.products.own_code_patch import rename_likely

WANTED = {
    path.rpartition("/")[2]: [GeneratedFile(path, b"", once=is_once)]
    for path, is_once in {
        "src/new_pkg/new_pkg/boss.py": True,
        "src/new_pkg/new_pkg/clock.py": True,
        "src/new_pkg/new_pkg/boss_contract.py": False,
        "src/eyes/include/eyes/finder_node.hpp": False,
        "src/eyes/include/eyes/finder_behaviour.hpp": True,
        "src/other/include/other/camera_node.hpp": False,
    }.items()
}


@pytest.mark.parametrize(
    ("path", "text", "expected"),
    [
        (
            "src/new_pkg/new_pkg/boss.py",
            "import os.path\nif X:\n    from old_pkg.boss_contract import BossPorts\nfrom geometry_msgs.msg import Twist\n",
            [(3, 10, "`old_pkg` has no `boss_contract` any more: it is `new_pkg` now")],
        ),
        # A library may have a module that is called as a component is.
        ("src/new_pkg/new_pkg/clock.py", "from rclpy.clock import Clock\nfrom new_pkg.boss_contract import X\n", []),
        (
            "src/new_pkg/test/test_boss.py",
            "from old_pkg.boss import Boss\nfrom old_pkg.boss_contract import BossFakeNode\nfrom rclpy.clock import Clock\n",
            [
                (1, 6, "`old_pkg` has no `boss` any more: it is `new_pkg` now"),
                (2, 6, "`old_pkg` has no `boss_contract` any more: it is `new_pkg` now"),
            ],
        ),
        (
            "src/eyes/src/finder_behaviour.cpp",
            '#include "sight/finder_behaviour.hpp"\n',
            [(1, 11, "`sight` has no `finder_behaviour.hpp` any more: it is `eyes` now")],
        ),
        ("src/new_pkg/new_pkg/boss.py", "from new_pkg.boss_contract import BossPorts\n", []),
        (
            "src/eyes/src/finder_behaviour.cpp",
            """#include "sight/finder_node.hpp"
#include "other/camera_node.hpp"
#include "std_msgs/msg/bool.hpp"
namespace sight
{
}  // namespace sight
namespace mine {}
""",
            [
                (1, 11, "`sight` has no `finder_node.hpp` any more: it is `eyes` now"),
                (4, 11, "what is generated is in another namespace: it is `eyes` now"),
            ],
        ),
    ],
)
def test_what_is_told(path: str, text: str, expected: list[tuple[int, int, str]]) -> None:
    found = list(find_moved_packages(path, text.encode(), WANTED))
    assert [(each.line, each.column, each.message) for each in found] == expected
    mended = rename_likely(path, text.encode(), found)
    assert not list(find_moved_packages(path, mended, WANTED))
