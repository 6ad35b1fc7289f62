"""Numbers printed in the reference paper, to be set beside ours.

G. N. de Boer et al., A porohyperelastic lubrication model for articular cartilage in the natural
synovial joint, Tribology International 149 (2020) 105760,
https://doi.org/10.1016/j.triboint.2019.04.044. They are a mark to look at, not to tune to.
"""

from dataclasses import dataclass

from porolub.io.words import LINE_LOAD, LINE_MASS_FLOW, NEWTON_PER_METRE, ONE, Unit


@dataclass(frozen=True)
class Printed:
    """A printed number.

    value: SI; keys: keys of the summary whose sum it is (``sommerfeld`` comes from the scene);
    unit: as printed; source: where it stands in the paper (3.2.1 and 3.2.2: at the end).
    """

    label: str
    value: float
    keys: tuple[str, ...]
    unit: Unit
    source: str


_INFLOW = ("inflow_left", "inflow_right")
_OUTFLOW = ("outflow_left", "outflow_right")

CASE_1 = {
    "L": Printed("load", 1500.0, ("load_total",), LINE_LOAD, "Table 3"),
    "L_f": Printed("fluid share", 904.0, ("load_fluid",), LINE_LOAD, "Sec. 3.2.1"),
    "L_s": Printed("solid share", 596.0, ("load_solid",), LINE_LOAD, "Sec. 3.2.1"),
    # the ratio of 0.91 and 0.59 kN/m, as Section 3.2.2 gives the shares; 904 / 596 is 1.517
    "Gamma": Printed("ratio", 1.542, ("load_ratio",), ONE, "Sec. 3.2.2"),
    "M_in": Printed("flow in", 0.185e-3, _INFLOW, LINE_MASS_FLOW, "Sec. 3.2.1"),
    "M_out": Printed("flow out", 0.219e-3, _OUTFLOW, LINE_MASS_FLOW, "Sec. 3.2.1"),
    "eta U/L": Printed("Sommerfeld", 6.67e-8, ("sommerfeld",), ONE, "Sec. 3.2.2"),
}

APPENDIX_A = {
    "L_s": Printed("solid share", 1390.0, ("load_solid",), NEWTON_PER_METRE, "Appendix A"),
    "L_f": Printed("fluid share", 110.0, ("load_fluid",), NEWTON_PER_METRE, "Appendix A"),
}

_BY_TITLE = {"Case 1:": CASE_1, "Appendix A:": APPENDIX_A}


def printed_for(title: str) -> dict[str, Printed] | None:
    """Return the printed numbers of the scene with this title, by their symbols, if there are."""
    for prefix, numbers in _BY_TITLE.items():
        if title.startswith(prefix):
            return numbers
    return None
