"""What the results of a scene hold: names, units and meanings of the columns and numbers that the
scripts record and of those that are evaluated from the record.
"""

from typing import Any

from ..freefem.describe import describe_record
from .contacts import CONTACT_COLUMNS, RUN_NUMBERS, at_both_ends
from .fields import POINT_COLUMNS

__all__ = ["describe_results"]


def describe_results(values: dict | None = None, script: str = "disc-plane") -> dict[str, Any]:
    """Returns what the results of a scene of edp/program/<script>.edp hold, by key:

    - `bodies`: the number of bodies; `columns` of history.csv; `summary`: the numbers of
      summary.json;
    - `body_columns` and `body_summary`: those of each of several bodies;
    - `damped` and `projected`: what both have besides for damped bodies and for nu above
      `plain_nu`;
    - `contact_columns` of contacts.csv;
    - `meanings`: by file and name the unit and the meaning.

    Raises BadInput if the script refuses the values, and NotInstalled without FreeFem++.
    """
    description = describe_record(values, script)
    index = description["summary"].index("contact_time") + 1
    description["summary"][index:index] = list(RUN_NUMBERS)
    description["contact_columns"] = [
        name for name in CONTACT_COLUMNS if name not in description["damped"]
    ]
    for key in ("summary", "body_summary"):
        description[key] = [name for row in description[key] for name in at_both_ends(row)]
    meanings = description["meanings"]
    meanings["summary"] |= {name: list(entry) for name, entry in RUN_NUMBERS.items()}
    meanings["summary"] |= {
        final: [entry[0], f"as {name}, at end_time; null unless the run goes on after the contact"]
        for name, entry in meanings["summary"].items()
        for final in at_both_ends(name)[1:]
    }
    meanings["contacts"] = {
        name: list(entry) for name, entry in CONTACT_COLUMNS.items() if entry[1]
    }
    meanings["points"] = {name: list(entry) for name, entry in POINT_COLUMNS.items()}
    return description
