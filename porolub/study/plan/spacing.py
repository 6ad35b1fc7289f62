"""Values from one end to another, in equal steps or equal ratios, exact where decimals are."""

from decimal import Context, Decimal
from typing import Literal

from porolub.errors import SceneError
from porolub.study.plan.amounts import amount, written
from porolub.study.plan.sweep_schema import End, Piece

Scale = Literal["linear", "log"]

DIGITS = 12
"""Significant digits of the values between the ends."""


def values_between(piece: Piece, scale: Scale, whole: bool) -> list[End]:
    """Return the values of a piece of an axis, ends included, as they stand in a scene file.

    All have the unit of the first one. Plain numbers stay plain; with ``whole`` they are rounded.
    Raises SceneError, without the key, where there is no such way from one end to the other.
    """
    first, last = amount(piece.start), amount(piece.to)
    ends = f"from = {piece.start!r} to = {piece.to!r}".replace("'", '"')
    if first is None or last is None or first.kind is not last.kind:
        raise SceneError(f'{ends}: two quantities of one kind are needed, such as "10 um"')
    if first.number == last.number:
        raise SceneError(f"{ends}: the two must differ")
    if scale == "log" and min(first.number, last.number) <= 0:
        raise SceneError(f"{ends}: equal ratios need ends greater than 0; use linear instead")
    a, b = first.given, last.given_in(first.unit)
    between = _ratios(a, b, piece.count) if scale == "log" else _steps(a, b, piece.count)
    if isinstance(piece.start, str):
        texts: list[End] = [written(number, first.unit) for number in between]
        texts[0] = piece.start
        at_end = amount(texts[-1])
        if at_end is None or at_end.number != last.number:  # deg to rad: no decimal is exact
            texts[-1] = piece.to
        return texts
    return [round(number) if whole else float(number) for number in between]


def _steps(a: Decimal, b: Decimal, count: int) -> list[Decimal]:
    last = count - 1
    digit = Decimal(1).scaleb(max(abs(a), abs(b)).adjusted() - DIGITS + 1)
    inner = [((a * (last - i) + b * i) / last).quantize(digit) for i in range(1, last)]
    return [a, *inner, b]


def _ratios(a: Decimal, b: Decimal, count: int) -> list[Decimal]:
    last, short = count - 1, Context(prec=DIGITS)
    inner = [short.plus(a * (b / a) ** (Decimal(i) / last)) for i in range(1, last)]
    return [a, *inner, b]
