"""rumoca, a Modelica compiler with solvers of its own, as an independent program.

Its Python interface takes no time-varying inputs yet, so a model around the exported one brings
them as tables, linear between samples.
"""

from __future__ import annotations

import numpy as np
import rumoca

TIGHT = {"solver": "bdf", "rtol": 1e-11, "atol": 1e-14}
PAGE = 100  # steps of a table in one function


def compiled(text, model):
    """The model of that name in a package's text."""
    return rumoca.Session().loads(text, model=model)


def driven(text, inputs, dt, idle=()):
    """The text with a model ``Driven`` added: its ``Coach`` under tables of samples.

    inputs : name → samples, dt apart. idle : names of inputs that stay zero.
    """
    package = text.rstrip().removesuffix(";").split()[-1]
    functions = [line for name, z in inputs.items() for line in _table(name, z, dt)]
    body = [
        "  model Driven",
        "    Coach coach;",
        "  equation",
        *(f"    coach.{name} = table_{name}(time);" for name in inputs),
        *(f"    coach.{name} = 0;" for name in idle),
        "  end Driven;",
        f"end {package};",
    ]
    kept = text.rstrip().removesuffix(f"end {package};")
    return kept + "\n".join([*functions, *body, ""])


def _table(name, z, dt):
    """A function of time, linear between samples.

    rumoca copies a table whenever a function that holds it is called: so each holds one page.
    """
    last = len(z) - 1
    firsts = range(0, last, PAGE)
    pages = [
        f"{'elseif' if k else 'if'} i < {k + PAGE} then u := page_{name}_{k}(i - {k} + 1, s - i);"
        for k in firsts
    ]
    return [
        *(line for k in firsts for line in _page(f"page_{name}_{k}", z[k : k + PAGE + 1])),
        f"  function table_{name}",
        "    input Real t;",
        "    output Real u;",
        "  protected",
        "    Integer i;",
        "    Real s;",
        "  algorithm",
        f"    s := t/{dt!r};",
        f"    i := min(max(integer(floor(s)), 0), {last - 1});",
        *(f"    {page}" for page in pages),
        "    end if;",
        f"  end table_{name};",
    ]


def _page(name, z):
    samples = ", ".join(repr(float(value)) for value in z)
    return [
        f"  function {name}",
        "    input Integer i;",
        "    input Real r;",
        "    output Real u;",
        "  protected",
        f"    constant Real z[{len(z)}] = {{{samples}}};",
        "  algorithm",
        "    u := z[i] + r*(z[i + 1] - z[i]);",
        f"  end {name};",
    ]


def simulated(model, stop, dt, **settings):
    """Time and every variable by name, from 0 to ``stop`` in steps of ``dt``, tightly solved.

    rumoca prepares the model anew each time, before the first step: the time of that is the time
    of a run to ``stop = dt``.
    """
    config = rumoca.SimConfig(**(TIGHT | settings))
    found = model.simulate((0.0, stop), dt=dt, config=config)
    return np.asarray(found.time), {name: np.asarray(found[name]) for name in found.names}
