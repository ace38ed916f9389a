"""Which rows of a table are headings, totals or data, and what is said of the rest."""

from __future__ import annotations

import pytest

from archgen.plugins.tables import table_import
from archgen.plugins.tables.table_cells import parse_heading_map
from archgen.plugins.tables.table_import import render_import_summary
from tests.plugins.tables.test_cell_ledger import find_silent_losses
from tests.workbooks import make_workbook


def _read(text: str, *heading_map: str) -> table_import.TableImport:
    imported = table_import.import_tables([("t.csv", text.encode())], "jazzy", parse_heading_map(heading_map))
    if imported.data:
        assert find_silent_losses(imported) == []
    return imported


def _messages(text: str, *heading_map: str) -> list[str]:
    return [f"{d.span.line}:{d.span.column} {d.message}" for d in _read(text, *heading_map).diagnostics]


def _components(imported: table_import.TableImport) -> dict[str, list[str]]:
    return {group: list(body["components"]) for group, body in imported.data["groups"].items()}


@pytest.mark.parametrize(
    ("text", "messages"),
    [
        # One output takes what stands beside it.
        ("Group,Component,Outputs,Message\nA,Lid,Scan,sensor_msgs/LaserScan\n", []),
        ("Group;Component;Outputs;Type;Topic\nA;Lid;scan;Laser scan;/scan\n", []),
        # Several take a line each, or nothing.
        (
            'Group,Component,Outputs,Message,Topic\nA,Cam,"Image\nInfo","sensor_msgs/Image\nsensor_msgs/CameraInfo","/image\n/info"\n',
            [],
        ),
        (
            "Group,Component,Outputs,Type\nA,Cam,Image; Info,Picture\n",
            ["2:19 `Picture` was not taken: which of the 2 outputs of `Cam` is it for?"],
        ),
        (
            "Group,Component,Outputs,Topic\nA,Cam,Image; Info,/im\n",
            ["2:19 `/im` was not taken: which of the 2 outputs of `Cam` is it for?"],
        ),
        (
            "Group,Component,Outputs,Data type\nA,Cam,Image; Info,sensor_msgs/Image\n",
            ["2:19 `sensor_msgs/Image` was not taken: which of the 2 outputs of `Cam` is it for?"],
        ),
        # Without an output there is nothing to take it.
        (
            "Group,Component,Message\nA,Lid,sensor_msgs/LaserScan\n",
            ["2:7 `sensor_msgs/LaserScan` was not taken: a row like this one has no place for it (message)"],
        ),
        # What flows, and of which type it is.
        ("Group,Component\nG,A\nG,B\n\nFrom,Signal,To,Type\nA,Scan,B,Laser scan\n", []),
        ("Group,Component,Lead partner\nG,A,Lab\n", []),
        # Requirements and types may have tables of their own.
        ("Requirement,Description\nR-1,It stops\n\nGroup,Component,Requirement\nG,A,R-1\n", []),
        ("Type,Message\nScan,sensor_msgs/LaserScan\n\nGroup,Component,Outputs\nG,A,Scan\n", []),
        ("Group,Component,Owner\nG,A,Lab\nG,A,Lab\n", []),
        (
            "Group,Component,Description,Owner,Rate\nG,A,Looks,Lab,1 Hz\nG,A,Sees,Bal,2 Hz\n",
            [
                "3:5 another row says something else on functionality of `A`: this was not taken",
                "3:10 another row says something else on owner of `A`: this was not taken",
                "3:14 `A` has another rate already: `2 Hz` was not taken",
            ],
        ),
        (
            "Group,Component,Rate,Period\nG,A,10,100\n",
            ["2:8 `100` was not taken: the row has a rate, and a period says the same"],
        ),
        (
            "Kind,Group,Component\nSensor,G,A\n",
            ["2:1 `Sensor` is no kind of row and was not taken"],
        ),
        (
            "Group,Component,Outputs,Provides\nG,A,Scan,Image\n",
            ["1:25 the column `Provides` means output like `Outputs`: the cell below it was not taken"],
        ),
        ("Group,Component\nG,A\n,,left\n", ["3:3 `left` stands below no heading and was not taken"]),
        (
            "Group,Component,Owner\nG,A,\nEmpty,,Lab\n",
            ["3:1 the group `Empty` has no component and was not taken"],
        ),
        (
            "Group,Component,Status\nG,A,\nG,,planned\n",
            ["3:4 `planned`: no component stands beside this: it was not taken"],
        ),
    ],
)
def test_what_stands_beside_a_name_is_taken_or_told(text: str, messages: list[str]) -> None:
    assert [message for message in _messages(text) if "stands in no group" not in message] == messages


@pytest.mark.parametrize(
    "row", ["Summe:,21", "Total,21", "Gesamt: 21,", "∑,3", "Total,1 200 €", "Zwischensumme,=SUM(B2:B9)", "Suma:,"]
)
def test_a_row_of_totals_is_no_group(row: str) -> None:
    text = f"Group,Component\nG,A\n{row}\n"
    assert _components(_read(text)) == {"g": ["a"]}
    assert len(_messages(text)) == 1
    assert "begins a row of totals, which was not taken" in _messages(text)[0]


@pytest.mark.parametrize("row", ["G,Sum", "Total,Adder", ",Total", "Sum,Sum"])
def test_a_component_may_be_called_like_a_total(row: str) -> None:
    assert sum(map(len, _components(_read(f"Group,Component\nG,A\n{row}\n")).values())) == 2
    assert _components(_read("Group,Component,Rate\nG,A,\n,Sum,30\n")) == {"g": ["a", "sum"]}


def test_headings_are_repeated_on_each_page() -> None:
    text = "Group,Component,Price\nG,A,3\nGroup,Component,Price\nG,B,4\n"
    assert _components(_read(text)) == {"g": ["a", "b"]}
    imported = _read(text)
    summary = "\n".join(render_import_summary(imported.ledger, imported.tables))
    assert "3 left out (repeats the headings)" in summary


def test_a_table_below_a_blank_row_may_have_a_column_that_is_not_known() -> None:
    text = "Group,Component\nG,A\nG,B\n\nFrom,Signal,To,Price\nA,Scan,B,3\n"
    assert _read(text).data["groups"]["g"]["components"]["b"]["inputs"] == {"scan": "a.scan"}


def test_a_heading_is_mapped_by_hand() -> None:
    text = "Hauptgruppe,Element,Preis\nG,A,cheap\n"
    assert _components(_read(text, "Hauptgruppe=group", "element=component")) == {"g": ["a"]}
    imported = _read(text, "Hauptgruppe=group", "Element=component", "Preis=description")
    assert imported.data["groups"]["g"]["components"]["a"]["description"] == "cheap"
    assert imported.diagnostics == ()


def test_the_column_that_is_mapped_counts_before_one_that_is_known() -> None:
    text = "Group,Component,Output,Provides\nG,A,Scan,Image\n"
    assert _read(text, "Provides=output").data["groups"]["g"]["components"]["a"]["outputs"] == {"image": "Image"}


def test_a_mapped_heading_that_no_table_has_is_told() -> None:
    assert _messages("Group,Component\nG,A\n", "Baugruppe=group") == [
        "1:1 no table has the heading that --map takes for group (`baugruppe`)"
    ]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("Baugruppe", "'Baugruppe' is no heading with its meaning: write \"Baugruppe=group\""),
        ("=group", "'=group' is no heading with its meaning"),
        ("A=grop", "'grop' is nothing that a column can mean. did you mean group? Columns mean: kind, group, "),
    ],
)
def test_a_map_that_means_nothing_is_refused(text: str, message: str) -> None:
    with pytest.raises(ValueError, match=r"^[^\n]+$") as raised:
        parse_heading_map((text,))
    assert str(raised.value).startswith(message)


def test_a_table_without_known_headings_is_one_error() -> None:
    imported = _read("Teileliste 7;;\nPosition;Werkstoff;Komponentt\n1;Stahl;Achse\n2;Stahl;Rad\n")
    (error,) = imported.diagnostics
    assert (str(error.severity), error.message) == (
        "error",
        (
            "no row has headings that archgen knows; the first rows are: `Teileliste 7`, `Position | Werkstoff | Komponentt`, "
            "`1 | Stahl | Achse`"
        ),
    )
    assert error.help is not None
    assert error.help.startswith(
        'say what the columns mean if they matter: --map "Position=MEANING" --map "Werkstoff=MEANING" '
        '--map "Komponentt=component"; a MEANING is one of: kind, group, component'
    )


def test_a_sheet_without_known_headings_beside_others_is_one_warning_and_listed() -> None:
    def write_sheet(*rows: tuple[str, ...]) -> str:
        cells = ["".join(f'<c t="inlineStr"><is><t>{text}</t></is></c>' for text in row) for row in rows]
        return f"<sheetData>{''.join(f'<row>{row}</row>' for row in cells)}</sheetData>"

    workbook = make_workbook(
        {"Cover": write_sheet(("Robot",), ("2026",)), "Parts": write_sheet(("Group", "Component"), ("G", "A"))}
    )
    imported = table_import.import_tables([("t.xlsx", workbook)], "jazzy")
    assert [(d.span.file, d.message) for d in imported.diagnostics] == [
        ("t.xlsx [Cover]", "no row of this table has headings that archgen knows: its 2 cells were not taken")
    ]
    assert list(render_import_summary(imported.ledger, imported.tables)) == [
        "t.xlsx [Cover]: 2 cells below headings: 0 taken, 2 not taken",
        "  not taken: A1 `Robot`: its table has no headings that archgen knows",
        "  not taken: A2 `2026`: its table has no headings that archgen knows",
        "t.xlsx [Parts]: 2 cells below headings: 2 taken, 0 not taken",
        "  headings: Group = group, Component = component",
    ]


def test_the_summary_lists_each_cell_of_an_unknown_column() -> None:
    imported = _read("Group,Component,Price,Rate [Hz]\nG,A,3 EUR,30\nG,B,tbd,5\nG,C,4 EUR,\n")
    assert list(render_import_summary(imported.ledger, imported.tables)) == [
        "t.csv: 11 cells below headings: 8 taken, 2 not taken, 1 left out (says nothing yet)",
        '  headings: Group = group, Component = component, Price is not taken (--map "Price=MEANING"), Rate [Hz] = rate in Hz',
        "  not taken: 2:5 `3 EUR`: its column `Price` was not taken",
        "  not taken: 4:5 `4 EUR`: its column `Price` was not taken",
    ]


@pytest.mark.parametrize(
    "text",
    [
        "Baugruppe;Komponente;Eingänge;Ausgänge\nG;Kamera;keine;Bild\nG;Regler;Bild von Kamera;keine\n",
        "Groupe;Composant;Entrées;Sorties\nG;Caméra;aucune;Bild\nG;Regler;Bild de Caméra;aucune\n",
        "Grupo;Componente;Entradas;Salidas\nG;Cámara;ninguna;Bild\nG;Regler;Bild desde Cámara;nada\n",
        "Group;Component;Inputs;Outputs\nG;Camera;none;Bild\nG;Regler;Bild from Camera;none\n",
    ],
)
def test_one_table_in_four_languages_is_one_project(text: str) -> None:
    imported = _read(text)
    assert imported.diagnostics == ()
    camera, regulator = imported.data["groups"]["g"]["components"].values()
    assert (camera["inputs"], camera["outputs"]) == ({}, {"bild": "Bild"})
    assert (len(regulator["inputs"]), regulator["outputs"]) == (1, {})


def test_a_hostile_heading_puts_no_command_into_the_option_to_type() -> None:
    (warning,) = _read("Group,Component,$(reboot)\nG,A,x\n").diagnostics
    assert warning.help is not None
    assert warning.help.startswith("--map '$(reboot)=MEANING' takes it")
