"""``railride optimise``: the parameters that ride best, within limits."""

from __future__ import annotations

import shlex
from typing import TYPE_CHECKING, Annotated, Any

import typer

from railride.cli import options, output
from railride.cli.options import FORMATS, Arguments, kmh
from railride.cli.progress import working

if TYPE_CHECKING:
    from railride.optimisation import LimitState, Optimum, ParetoFront
    from railride.studies import Study


@output.exits_cleanly
def optimise(
    study: Annotated[
        str,
        typer.Argument(metavar="STUDY.toml", help="A study file, or the name of a shipped study."),
    ],
    vehicle_file: Annotated[
        str | None,
        typer.Option(metavar="FILE", rich_help_panel=options.RESULT,
                     help="Write the changed vehicle into this parameter file, for --vehicle of "
                     "the other commands."),
    ] = None,
    plot: Annotated[
        str | None,
        typer.Option(metavar="FILE", rich_help_panel=options.RESULT,
                     help="Draw comfort, limits and parameters before and after, and the front, "
                     "into this PNG, PDF or SVG file."),
    ] = None,
    form: options.FormatOption = "table",
    to: options.OutputOption = None,
) -> None:  # fmt: skip
    """Choose the parameters of a study so that a_wrms is least, within its limits.

    The study's keys are in docs/study-files.md. JSON keys: parameters (name → SI value), a_wrms
    (the goal, m/s²), limits (name, mode, at_least, bound, unit, before, value, of, binds, worth:
    what a unit of the limit changes in a_wrms), a_wrms_before, objective, cases, changes,
    iterations, evaluations, kkt_residual, converged, error, front (null, or against, unit and
    designs), body_options, remarks. CSV has the changes, a row per parameter.

    Example:  railride optimise optimise --vehicle-file best.toml --plot best.png
    """
    given = Arguments()
    given.choice("--format", form, FORMATS)
    written = {"--output": to, "--vehicle-file": vehicle_file, "--plot": plot}
    given.writes(written, {"STUDY.toml": study})
    given.check()
    with working("optimising") as advance:
        from railride.optimisation import read_task

        read, task = read_task(study)
        if vehicle_file is not None:
            task.check_vehicle()
        found = task.run(advance)
        drawn = None
        if plot is not None:
            from railride import plots

            drawn = plots.plot_optimum(found)
    text = output.result(form, _document(found), _flat(found), lambda: _table(read, found),
                         found.remarks)  # fmt: skip
    if vehicle_file is not None:
        from railride.parameters import write_vehicle

        write_vehicle(found.vehicle(), vehicle_file)
    if drawn is not None and plot is not None:
        plots.save(drawn, plot)
    output.deliver(text, to, found.remarks, plot)
    if vehicle_file is not None:
        typer.echo(
            f"written: {vehicle_file}; ride it: {_ride(read, found, vehicle_file)}", err=True
        )


def _document(found: Optimum) -> dict[str, Any]:
    return {
        "parameters": found.parameters,
        "a_wrms": found.a_wrms,
        "limits": [_limit(state) for state in found.limits],
        "a_wrms_before": found.a_wrms_before,
        "objective": found.objective,
        "cases": [
            {"track": c.track, "speed_kmh": kmh(c.speed), "position_m": c.position,
             "a_wrms": c.after, "a_wrms_before": c.before}
            for c in found.cases_changed
        ],
        "changes": _flat(found),
        "iterations": found.iterations,
        "evaluations": found.evaluations,
        "kkt_residual": found.residual,
        "converged": found.converged,
        "error": found.error,
        "front": None if found.front is None else _front(found.front),
        "body_options": found.model.body.options,
    }  # fmt: skip


def _limit(state: LimitState) -> dict[str, Any]:
    limit = state.limit
    return {
        "name": limit.kind,
        "mode": limit.mode or None,
        "at_least": limit.at_least,
        "bound": limit.bound,
        "unit": limit.unit,
        "before": state.before,
        "value": state.value,
        "of": state.of,
        "binds": state.binds,
        "worth": state.worth,
    }


def _front(front: ParetoFront) -> dict[str, Any]:
    from railride.optimisation import KINDS

    names = [variable.name for variable in front.variables]
    rows = zip(front.parameters.tolist(), front.travel.tolist(), front.a_wrms.tolist(),
               front.residuals.tolist(), strict=True)  # fmt: skip
    return {
        "against": front.against,
        "unit": KINDS[front.against].unit,
        "designs": [
            {"parameters": dict(zip(names, values, strict=True)), "travel": travel, "a_wrms": a,
             "kkt_residual": residual}
            for values, travel, a, residual in rows
        ],
    }  # fmt: skip


def _flat(found: Optimum) -> list[dict[str, Any]]:
    """What changed: a row per parameter."""
    return [
        {
            "parameter": change.variable.name,
            "symbol": change.variable.symbol,
            "meaning": change.variable.meaning,
            "unit": change.variable.unit,
            "from": change.variable.own,
            "to": change.value,
            "change": change.relative,
            "lower": change.variable.lower,
            "upper": change.variable.upper,
            "at_bound": change.at_bound or None,
            "bound_worth": change.worth,
        }
        for change in found.changes
    ]


def _table(study: Study, found: Optimum) -> str:
    """What changed, what it gains, the limits, the front, and how good the optimum is."""
    shown = [_changes(study, found), _cases(found)]
    shown += [_limits(found)] if found.limits else []
    shown += [_front_table(found.front)] if found.front is not None else []
    state = "an optimum" if found.converged else "NOT converged"
    before = "-" if found.a_wrms_before is None else f"{found.a_wrms_before:.4f}"
    goal = {"mean": "mean of the cases", "worst": "worst case"}[found.objective]
    shown.append(
        f"  a_wrms, {goal}: {before} → {found.a_wrms:.4f} m/s². {state.capitalize()}: residual of "
        f"the optimality\n  conditions {found.residual:.0e} after {found.iterations} iterations, "
        f"{found.evaluations} designs evaluated.\n"
    )
    return "\n".join(shown)


def _changes(study: Study, found: Optimum) -> str:
    columns = [("parameter", ""), ("unit", ""), ("from", ".6g"), ("to", ".6g"), ("change", "+.1%"),
               ("lower\nbound", ".6g"), ("upper\nbound", ".6g"), ("at bound", "")]  # fmt: skip
    rows = [
        (c.variable.name, c.variable.unit, c.variable.own, c.value, c.relative, c.variable.lower,
         c.variable.upper, c.at_bound)
        for c in found.changes
    ]  # fmt: skip
    return output.table_text(f"{study.name}: what changed", columns, rows)


def _cases(found: Optimum) -> str:
    columns = [("track", ""), ("speed\n[km/h]", ".6g"), ("at\n[m]", ".6g"),
               ("a_wrms before\n[m/s²]", ".4f"), ("after\n[m/s²]", ".4f"),
               ("change", "+.1%")]  # fmt: skip
    rows = [
        (c.track, kmh(c.speed), c.position, c.before, c.after,
         c.after / c.before - 1 if c.before else None)
        for c in found.cases_changed
    ]  # fmt: skip
    title = f"Comfort, {found.cases.floor} floor, {found.cases.weight.name} weighted, exact"
    return output.table_text(title, columns, rows)


def _limits(found: Optimum) -> str:
    columns = [("limit", ""), ("", ""), ("bound", ".4g"), ("unit", ""), ("before", ".4g"),
               ("after", ".4g"), ("binds", ""), ("a_wrms per unit\n[m/s²]", "+.2e"),
               ("nearest to it", "")]  # fmt: skip
    rows = []
    for state in found.limits:
        times, unit = (1e3, "mm") if state.limit.unit == "m" else (100.0, "%")
        before = None if state.before is None else times * state.before
        rows.append((state.limit.name, state.limit.side, times * state.limit.bound, unit, before,
                     times * state.value, "yes" if state.binds else "no",
                     state.worth / times if state.binds else None, state.of))  # fmt: skip
    return output.table_text("Limits, and what one unit more of those that bind does to a_wrms",
                             columns, rows)  # fmt: skip


def _front_table(front: ParetoFront) -> str:
    from railride.optimisation import KINDS

    times, unit = (1e3, "mm") if KINDS[front.against].unit == "m" else (100.0, "%")
    columns = [(f"{front.against}\n[{unit}]", ".4g"), ("a_wrms\n[m/s²]", ".4f"),
               *((f"{v.name}\n[{v.unit}]".replace("[]", ""), ".6g") for v in front.variables),
               ("residual", ".0e")]  # fmt: skip
    rows = zip((times * front.travel).tolist(), front.a_wrms.tolist(), *front.parameters.T.tolist(),
               front.residuals.tolist(), strict=True)  # fmt: skip
    return output.table_text("The front of comfort against travel: none of these is beaten in both",
                             columns, rows)  # fmt: skip


def _ride(study: Study, found: Optimum, vehicle_file: str) -> str:
    """The command that rides the changed vehicle."""
    cases = found.cases
    words = ["railride ride --vehicle", shlex.quote(vehicle_file), found.model.body.options]
    words += [f"--speed {kmh(speed):g}" for speed in cases.speeds]
    words += [f"--at {x:g}" for x in cases.positions if cases.positions != (0.0,)]
    words += [f"--floor {cases.floor}"] if cases.floor != "smooth" else []
    track = study.ride.files[0] or cases.tracks[0].name
    words += [f"--track {shlex.quote(str(track))}"]
    return " ".join(words) + " --spectral"
