"""The words that head the columns of tables, by language and meaning, and how spellings of one word are folded."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator, Mapping

HEADING_WORDS: Mapping[str, Mapping[str, str]] = {
    "English": {
        "kind": "kind; row; row type; record; element; element type; entry",
        "group": "group; functional group; subsystem; group name; group id; area; layer; system; module group; assembly",
        "component": "component; functional component; software component; component name; module; block; function name; "
        "functional block",
        "id": "id; identifier; component id; key; short name",
        "title": "title; name; label; display name; full name",
        "functionality": "functionality; purpose; function; what it does; task; does",
        "description": "description; comment; note; remark; details; summary",
        "owner": "owner; partner; lead partner; responsible; responsible partner; organisation; organization; lead; company; "
        "team; owned by; supplier",
        "role": "role",
        "input": "input; in; input port; to input; to port; target port; target input; consumes; needs; input name; "
        "requires; destination port; inputs from",
        "output": "output; out; output port; from output; from port; source port; source output; provides; produces; "
        "gives; output name; outputs to",
        "from": "from; source; from component; source component; sender; producer; publisher; writer; provider; origin; src; "
        "publisher component; input from",
        "to": "to; target; to component; target component; destination; destination component; receiver; consumer; "
        "subscriber; reader; sink; dst; dest; subscriber component; output to",
        "from_group": "from group; source group; producer group; source subsystem; from subsystem",
        "to_group": "to group; target group; destination group; consumer group; target subsystem; to subsystem",
        "signal": "signal; data; content; payload; information; what; data item; flow",
        "type": "type; data type; conceptual type; signal type",
        "message": "message; ros message; msg; message type; msg type; ros type; interface; ros msg; ros interface; "
        "ros message type",
        "node": "node; ros node; node name",
        "package": "package; ros package; pkg",
        "topic": "topic; ros topic; topic name",
        "rate": "rate; frequency; freq; hz; update rate; publish rate; rate hz; frequency hz",
        "period": "period; cycle; cycle time; period ms; cycle time ms",
        "requirement": "requirement; req; requirement id; req id",
        "status": "status; node status",
    },
    "German": {
        "kind": "Art; Zeilenart; Elementart; Eintrag",
        "group": "Gruppe; Gruppen; Funktionsgruppe; Baugruppe; Baugruppen; Teilsystem; Untersystem; Bereich; Ebene; Schicht; "
        "Gruppenname; Modulgruppe",
        "component": "Komponente; Komponenten; Komponentenname; Softwarekomponente; Bauteil; Bauteile; Baustein; Bausteine; "
        "Modul; Module; Modulname; Funktionsblock; Block; Gerät",
        "id": "Kennung; Kürzel; Schlüssel; Kurzname; Kurzzeichen; Bezeichner",
        "title": "Titel; Bezeichnung; Benennung; Anzeigename; Name",
        "functionality": "Funktion; Funktionen; Funktionalität; Zweck; Aufgabe; Aufgaben; was es tut; Tätigkeit",
        "description": "Beschreibung; Beschreibungen; Bemerkung; Bemerkungen; Anmerkung; Anmerkungen; Kommentar; Kommentare; "
        "Notiz; Notizen; Hinweis; Hinweise; Erläuterung",
        "owner": "Verantwortlich; Verantwortlicher; Verantwortliche; Verantwortlichkeit; Zuständig; Zuständigkeit; "
        "Eigentümer; Partner; Lieferant; Firma; Organisation; Team; verantwortlicher Partner",
        "role": "Rolle; Rollen",
        "input": "Eingang; Eingänge; Eingabe; Eingaben; Eingangsport; Eingangssignal; Eingangssignale; Eingangsdaten; "
        "Zieleingang; benötigt; an Eingang; empfängt",
        "output": "Ausgang; Ausgänge; Ausgabe; Ausgaben; Ausgangsport; Ausgangssignal; Ausgangssignale; Ausgangsdaten; "
        "Quellausgang; liefert; erzeugt; von Ausgang; sendet",
        "from": "von; Quelle; Quellkomponente; Sender; Erzeuger; Absender; Herkunft; von Komponente; Ursprung",
        "to": "nach; an; zu; Ziel; Zielkomponente; Empfänger; Verbraucher; Senke; nach Komponente; an Komponente",
        "from_group": "von Gruppe; Quellgruppe; von Baugruppe; Quellbaugruppe",
        "to_group": "nach Gruppe; an Gruppe; Zielgruppe; nach Baugruppe; Zielbaugruppe",
        "signal": "Signal; Signale; Daten; Inhalt; Information; Informationen; Datenfluss",
        "type": "Typ; Datentyp; Datenart; Signaltyp",
        "message": "Nachricht; Nachrichten; Nachrichtentyp; ROS-Nachricht; ROS-Typ; Schnittstelle",
        "node": "Knoten; ROS-Knoten; Knotenname",
        "package": "Paket; Pakete; ROS-Paket; Paketname",
        "topic": "Topic; Thema; ROS-Thema; Topicname",
        "rate": "Rate; Frequenz; Takt; Taktrate; Abtastrate; Wiederholrate; Senderate; Bildrate",
        "period": "Periode; Periodendauer; Zyklus; Zykluszeit; Taktzeit; Abtastzeit",
        "requirement": "Anforderung; Anforderungen; Anforderungs-ID; Anf",
        "status": "Status; Zustand; Stand; Reifegrad",
    },
    "French": {
        "kind": "genre; nature; sorte; type de ligne",
        "group": "groupe; groupe fonctionnel; sous-système; ensemble; sous-ensemble; domaine; couche; système; nom du groupe",
        "component": "composant; composant logiciel; composant fonctionnel; nom du composant; module; bloc; bloc fonctionnel; brique",
        "id": "identifiant; identificateur; clé; nom court; abréviation",
        "title": "titre; nom; libellé; désignation; intitulé",
        "functionality": "fonction; fonctionnalité; but; rôle fonctionnel; tâche; objectif; ce qu'il fait",
        "description": "description; commentaire; remarque; note; détail; résumé; observation",
        "owner": "responsable; partenaire; partenaire responsable; propriétaire; fournisseur; organisation; organisme; société; "
        "entreprise; équipe; chef de file",
        "role": "rôle",
        "input": "entrée; port d'entrée; données d'entrée; nom de l'entrée; entrée cible; consomme; reçoit; besoin; vers l'entrée",
        "output": "sortie; port de sortie; données de sortie; nom de la sortie; sortie source; fournit; produit; émet; "
        "depuis la sortie",
        "from": "de; depuis; source; composant source; émetteur; producteur; expéditeur; origine; du composant; provenance",
        "to": "vers; à; cible; destination; composant cible; composant destinataire; récepteur; consommateur; destinataire; "
        "puits; vers le composant",
        "from_group": "groupe source; du groupe; groupe émetteur; depuis le groupe",
        "to_group": "groupe cible; vers le groupe; groupe destinataire; groupe récepteur",
        "signal": "signal; signaux; donnée; contenu; information; flux; flux de données; quoi",
        "type": "type; type de donnée; type des données; type de signal; type conceptuel",
        "message": "message; message ROS; type de message; type ROS; interface; interface ROS",
        "node": "nœud; nœud ROS; nom du nœud",
        "package": "paquet; paquet ROS; paquetage; nom du paquet",
        "topic": "topic; sujet; sujet ROS; nom du topic; thème",
        "rate": "fréquence; cadence; taux; débit d'images; fréquence de publication; fréquence de mise à jour",
        "period": "période; cycle; temps de cycle; durée du cycle; périodicité",
        "requirement": "exigence; exigences; besoin client; identifiant d'exigence; id exigence",
        "status": "statut; état; avancement",
    },
    "Spanish": {
        "kind": "clase; género; tipo de fila; tipo de elemento",
        "group": "grupo; grupo funcional; subsistema; sistema; conjunto; subconjunto; área; capa; nombre del grupo",
        "component": "componente; componente de software; componente funcional; nombre del componente; módulo; bloque; "
        "bloque funcional",
        "id": "identificador; clave; nombre corto; abreviatura",
        "title": "título; nombre; etiqueta; denominación; nombre completo",
        "functionality": "función; funcionalidad; funciones; propósito; finalidad; tarea; objetivo; qué hace",
        "description": "descripción; descripciones; comentario; observación; observaciones; nota; detalle; resumen",
        "owner": "responsable; socio; socio responsable; propietario; proveedor; organización; empresa; equipo; encargado",
        "role": "rol; papel; roles; papeles",
        "input": "entrada; puerto de entrada; datos de entrada; nombre de la entrada; entrada destino; consume; recibe; necesita; "
        "a la entrada",
        "output": "salida; puerto de salida; datos de salida; nombre de la salida; salida origen; proporciona; produce; "
        "desde la salida",
        "from": "de; desde; origen; fuente; componente origen; componente de origen; emisor; productor; del componente; "
        "componente fuente",
        "to": "a; hacia; hasta; destino; componente destino; componente de destino; receptor; consumidor; destinatario; "
        "al componente; sumidero",
        "from_group": "grupo origen; grupo de origen; del grupo; grupo fuente; desde el grupo",
        "to_group": "grupo destino; grupo de destino; al grupo; hacia el grupo",
        "signal": "señal; señales; dato; contenido; información; flujo; flujo de datos; qué",
        "type": "tipo; tipo de dato; tipo de señal; tipo conceptual",
        "message": "mensaje; mensaje ROS; tipo de mensaje; tipo ROS; interfaz; interfaz ROS",
        "node": "nodo; nodo ROS; nombre del nodo",
        "package": "paquete; paquete ROS; nombre del paquete",
        "topic": "tópico; tópico ROS; topic; tema; nombre del tópico",
        "rate": "frecuencia; tasa; cadencia; frecuencia de publicación; frecuencia de actualización",
        "period": "período; ciclo; tiempo de ciclo; periodicidad; duración del ciclo",
        "requirement": "requisito; requerimiento; requisitos; id de requisito; identificador del requisito",
        "status": "estado; estatus; situación",
    },
}
"""The columns' headings by language and key. Plurals in `s` and spellings without accents need no entry of their own."""
TARGETS = tuple(HEADING_WORDS["English"])
"""What a column may mean."""
TOTAL_WORDS = frozenset(
    {"total", "totals", "subtotal", "subtotals", "sum", "grandtotal"}
    | {"summe", "summen", "gesamt", "gesamtsumme", "zwischensumme", "insgesamt", "anzahl"}
    | {"totaux", "soustotal", "somme", "totalgeneral", "nombre", "suma", "totales", "subtotales"}
)
"""What a row of totals begins with, folded."""
_GERMAN_SPELLINGS = str.maketrans({"ä": "ae", "ö": "oe", "ü": "ue", "ß": "ss"})
_LIGATURES = str.maketrans({"œ": "oe", "æ": "ae", "ß": "ss"})


def fold_heading(text: str) -> str:
    """Fold a heading: case, camel case, accents, blanks, hyphens and punctuation do not tell two apart."""
    spaced = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", unicodedata.normalize("NFC", text))
    plain = unicodedata.normalize("NFKD", spaced.casefold().translate(_LIGATURES)).encode("ascii", "ignore").decode()
    # A heading in another script keeps its letters, so that it can be mapped by hand.
    return "".join(re.findall(r"[a-z0-9]+", plain)) or "".join(text.casefold().split())


def _fold_spellings(word: str) -> Iterator[str]:
    """Yield the folded spellings of one heading: singular and plural, umlauts as `ae` or `a`."""
    for spelling in (word, word.casefold().translate(_GERMAN_SPELLINGS)):
        folded = fold_heading(spelling)
        yield folded
        # A plural of one or two letters would be a word of its own: `as`, `ids` apart.
        if len(folded) > 2 or folded == "id":  # noqa: PLR2004 - as above
            yield f"{folded}s"


def _index_words() -> Mapping[str, str]:
    index: dict[str, str] = {}
    for words_by_key in HEADING_WORDS.values():
        for key, words in words_by_key.items():
            for word in words.split(";"):
                for folded in _fold_spellings(word):
                    index.setdefault(folded, key)
            index.setdefault(fold_heading(key), key)
    return index


KEY_BY_HEADING = _index_words()
"""The key by folded heading, of all languages."""
