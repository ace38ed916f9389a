"""Tables as partners sent them: a supplier's workbook, a French CSV file, connections, a Word document, and a messy one.

Their cells were counted with other programs than archgen.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.plugins.tables import table_import
from archgen.start import project_plan, start_answers
from tests.plugins.tables.test_cell_ledger import find_silent_losses

TABLES = Path(__file__).parent / "partner_tables"


def _import(name: str) -> table_import.TableImport:
    return table_import.import_tables([(name, (TABLES / name).read_bytes())], "jazzy")


@pytest.mark.parametrize(
    ("name", "count", "components", "not_taken"),
    [
        (
            "greifmodul.xlsx",
            81,
            "sensorik: kraftmesssensor handkamera endschalter, regelung: kraftregler greifplanung, unsorted: handantrieb",
            (
                "[Komponenten] K5, [Komponenten] L5, [Komponenten] K6, [Komponenten] L6, [Komponenten] K7, [Komponenten] L7, "
                "[Komponenten] K8, [Komponenten] B10, [Komponenten] C10, [Komponenten] K10, [Komponenten] B2, "
                "[Deckblatt] B2, [Deckblatt] B3, [Deckblatt] C3, [Deckblatt] B4, [Listen] A1, [Listen] A2"
            ),
        ),
        (
            "navigation.csv",
            61,
            "perception: telemetre_laser camera_a_l_arriere, navigation: evitement_d_obstacles planificateur base_mobile",
            "2:129, 7:84, 8:1, 8:7, 8:17, 6:79, 6:90",
        ),
        (
            "conexiones.xlsx",
            58,
            "unsorted: camara_frontal deteccion_de_senales planificacion gps registro control_de_direccion pantalla",
            (
                "[Conexiones] A2, [Conexiones] A3, [Conexiones] A4, [Conexiones] A5, [Conexiones] A6, [Conexiones] A7, "
                "[Conexiones] A9, [Conexiones] B9, [Conexiones] G7"
            ),
        ),
        (
            "arm_icd.docx",
            49,
            "arm: joint_driver trajectory_planner, tasks: task_manager",
            (
                "[table 2] row 5, column 1; [table 1] row 1, column 1; [table 1] row 1, column 2; [table 1] row 1, column 3; "
                "[table 1] row 2, column 1; [table 1] row 2, column 2; [table 1] row 2, column 3; "
                "[table 1] row 3, column 1; [table 1] row 3, column 2; [table 1] row 3, column 3; [table 3] row 2, column 6"
            ),
        ),
        (
            "messy.csv",
            58,
            "sensing: lidar_front imu, driving: base",
            (
                "7:35, 7:43, 8:39, 13:13, 15:2, 15:8, 2:2, 7:25, 11:10, 11:56, 11:2, 12:33, 6:14, 9:33, 11:45, 12:22, "
                "9:17, 11:18, 11:27, 11:51, 12:16"
            ),
        ),
    ],
)
def test_nothing_of_a_partners_table_is_lost_silently(name: str, count: int, components: str, not_taken: str) -> None:
    imported = _import(name)
    cells = [cell for table in imported.tables for cell in (*table.cells, *table.placeholders)]
    headings = [cell for table in imported.tables for known in table.headings for cell in known.cells.values()]
    assert len(cells) + len(headings) == count
    assert find_silent_losses(imported) == []
    assert (
        ", ".join(f"{group}: {' '.join(body['components'])}" for group, body in imported.data["groups"].items())
        == components
    )
    places = [span.file.removeprefix(name).strip() or f"{span.line}:{span.column}" for span in imported.ledger.reasons]
    assert ("; " if ";" in not_taken else ", ").join(places) == not_taken


@pytest.mark.parametrize("name", sorted(path.name for path in TABLES.iterdir()))
def test_the_project_of_a_partners_table_has_no_errors(name: str) -> None:
    imported = _import(name)
    answers = start_answers.add_partners(start_answers.collect_answers("r"), imported.data.get("partners", {}))
    files = project_plan.imported_files(answers, imported.data)
    assert [d.message for d in project_plan.judge_files(files, "r").findings if d.severity == "error"] == []


def test_a_suppliers_workbook_keeps_what_it_says() -> None:
    data = _import("greifmodul.xlsx").data
    regulator = data["groups"]["regelung"]["components"]["kraftregler"]
    assert regulator == {
        "functionality": "Hält die Greifkraft",
        "owner": "mueller_antriebe_gmbh",
        "inputs": {
            "ziel": "greifplanung.greifpose",
            "greifkraft": "kraftmesssensor.greifkraft",
            "oeffnungszustand": "endschalter.oeffnungszustand",
        },
        "outputs": {"stellgroesse": "Stellgröße"},
        "timing": {"period": "0.002 s"},
    }
    assert data["partners"]["juergens_and_soehne"] == "Jürgens & Söhne"
    assert data["types"]["Kamerainfo"] == "sensor_msgs/msg/CameraInfo"
