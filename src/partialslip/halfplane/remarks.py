"""What a result of the exact method leaves undetermined, and its notes."""

from partialslip.result import FRICTIONLESS, PATH_DEPENDENT, RATCHETS, Regime


def undetermined(regime: Regime, turns: bool, found: object) -> dict[str, str]:
    """Why quantities cannot serve as a reference, by quantity: slip ``turns`` round between the load points, or
    ``found``, q1 and q2, is a reason instead. Where the contact ratchets, the closed form is that of no cycle."""
    if regime in ("sliding", "frictionless"):
        return {}
    if turns:
        reason = f"{PATH_DEPENDENT}between the load points, and one step does not hold"
        return dict.fromkeys(("m", "n", "q", "q1", "q2"), reason)
    levels = dict.fromkeys(("q1", "q2"), found) if isinstance(found, str) else {}
    return levels | (dict.fromkeys(("m", "n", "q"), RATCHETS) if regime == "ratchets" else {})


def remarks(regime: Regime, turns: bool, undetermined: dict[str, str], anew: bool) -> tuple[str, ...]:
    """Notes on the result; ``anew``: whether the pressure varies."""
    if regime == "frictionless":
        return (FRICTIONLESS,)
    if regime == "sliding":
        once = "" if anew else ", or dQ >= 2 f P"
        return (f"the contact slides: |Q| >= f P at a load point{once}; there is no steady partial slip",)
    notes: list[str] = []
    if regime == "ratchets":
        beyond = "outside the bounds" if anew else "above the bound"
        notes.append(f"the mean of Q is {beyond} for a steady state: the contact ratchets")
    elif not turns and "q2" in undetermined:
        notes.append(f"q1 and q2: {undetermined['q2']}")
    if turns:
        notes.append(f"m, n, q: {undetermined['m']}")
    return tuple(notes)


def no_stresses(found: object) -> dict[str, str]:
    """Why the stresses are not known: ``found``, q1 and q2, is a reason instead."""
    return {"stresses": f"q1 and q2 are not known: {found}"}
