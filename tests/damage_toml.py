"""How TOML files are damaged, as those of :mod:`damage`; and changes that mean the same."""

from __future__ import annotations

import re
from decimal import Decimal

from damage import NUMBERS, SAME_LINES, damage_line, put

UNITS = ["", "kg", "t", "m", "mm", "km", "s", "N/m", "kN/mm", "N s/m", "kg m^2", "N m^2", "Hz",
         "N m/rad", "km/h", "%", "rad", "m^2", "m^99", "m**m", "parsec", "kg kg", "1/s", "/",
         "N//m", "m)", "(m", "µm", "\\u00b5m", "°", "__", "m/m", "e", "nan", "1"]  # fmt: skip
VALUES = ["", "true", "false", "nan", "inf", "-inf", "1e999", "0", "-1", "3", "3.5", "0x10", "1e16",
          "9" * 30, "9" * 5000, "1979-05-27", "07:32:00", "1979-05-27T07:32:00Z", "[]", "{}",
          "[[]]", "[1]", '["a"]', "[nan]", '["1 m", 2]', "{ a = 1 }", '""', '" "', '"nan"',
          '"\\u0000"',
          '"a\\nb"', '"$x^$"', '"\\u001b[31m"', '"\\U0001F686"', "'''a\nb'''", '"."', '".."', '"/"',
          '"none.csv"', '"rigid"', '"fe"', '"sobol"', '"worst"', "[" * 400, "None", "'",
          '"' + "x" * 5000 + '"', '["0 m"]', '["0 m", "0 m"]', '["1 m", "-1 m"]',
          '["-1 m", "1 m"]']  # fmt: skip
KEYS = """mass pitch_inertia length mass_centre bending_frequency bending_frequencies cuts
joint_stiffness bending_stiffness shear_stiffness rotary_inertia joint_damping bending_damping
rayleigh_mass rayleigh_stiffness mode_damping inertia wheelsets primary_stiffness position
primary_damping
secondary_stiffness secondary_damping wheelset_mass primary_damper_stiffness front rear frequency
secondary_damper_stiffness stiffness damping damping_ratio schema name vehicle segments kind modes
speeds tracks positions floor weighting extrapolate results from to points spacing values mean mode
distribution deviation alpha beta file number method seed chunk format objective weights search
starts against secondary_travel distance secondary_static wheel_load_variation percentiles indices
notes note source remarks""".split()

LINE = re.compile(r"^([ \t]*)([\w-]+)([ \t]*=[ \t]*)(.+)$", re.MULTILINE)
HEADER = re.compile(r"^\[.*\]$", re.MULTILINE)
QUANTITY = re.compile(r'"([-+]?\d[\d.]*(?:e[-+]?\d+)?)( [^"\n]+)?"')


def scale(rng, number):
    """The number in another size, or of the other sign."""
    power = rng.choice((-30, -12, -6, -3, -2, -1, 0, 1, 2, 3, 6, 12, 30))
    factor = rng.choice((1, 2, 5, -1)) * Decimal(10) ** power
    return f"{factor * Decimal(number):.12g}"


def _quantity(new):
    """Numbers and units of quantities put otherwise."""
    return lambda rng, text: put(
        rng, QUANTITY, text, lambda one: f'"{new(rng, one[1], one[2] or "")}"'
    )


def _value(new):
    """The value of a key put otherwise."""
    return lambda rng, text: put(rng, LINE, text, lambda one: "".join(one.groups()[:3])
                                 + new(rng, one[4]))  # fmt: skip


def _key(new):
    return lambda rng, text: put(rng, LINE, text, lambda one: one[1] + new(rng, one[2])
                                 + one[3] + one[4])  # fmt: skip


def exchange_values(rng, text):
    lines = list(LINE.finditer(text))
    one, other = rng.choice(lines), rng.choice(lines)
    if one.start() > other.start():
        one, other = other, one
    if one is other:
        return text
    return (text[: one.start(4)] + other[4] + text[one.end(4) : other.start(4)] + one[4]
            + text[other.end(4) :])  # fmt: skip


def misspell(rng, key):
    place = rng.randrange(len(key))
    return rng.choice((
        key[:place] + key[place + 1 :] or "x",
        key[:place] + key[place] + key[place:],
        key.upper(),
        f'"{key}"',
        key + ".x",
        '""',
    ))  # fmt: skip


def damage_header(rng, text):
    """A table lost, doubled, renamed, made a list or none, or put into another."""
    return put(rng, HEADER, text, lambda one: rng.choice((
        "",
        f"{one[0]}\n{one[0]}",
        one[0].replace("[[", "[").replace("]]", "]"),
        f"[{one[0]}]" if not one[0].startswith("[[") else one[0],
        one[0].replace("]", ".deeper]", 1),
        one[0].replace("[", "[body.", 1),
        "[body]",
        "[[bogies]]",
        "[parameters.k_2]",
        one[0][:-1],
        one[0] + " x",
    )))  # fmt: skip


TOML = {
    "a line": damage_line,
    "a number": _quantity(lambda rng, _, unit: rng.choice(NUMBERS) + unit),
    "a size": _quantity(lambda rng, number, unit: scale(rng, number) + unit),
    "a unit": _quantity(lambda rng, number, _: f"{number} {rng.choice(UNITS)}"),
    "a decimal comma": _quantity(lambda _, number, unit: number.replace(".", ",") + ",5" + unit),
    "a value": _value(lambda rng, _: rng.choice(VALUES)),
    "a value in a list": _value(lambda rng, value: rng.choice(("[{}]", "[[{}]]", "{{ x = {} }}",
                                                              "[{0}, {0}]")).format(value)),
    "a bare value": _value(lambda _, value: value.replace('"', "")),
    "two values changed about": exchange_values,
    "a key misspelt": _key(misspell),
    "another key": _key(lambda rng, _: rng.choice(KEYS)),
    "a key more": lambda rng, text: put(rng, LINE, text, lambda one: f"{one[0]}\n"
                                        f"{rng.choice(KEYS)} = {rng.choice(VALUES)}"),
    "a table": damage_header,
    "a mark less": lambda rng, text: put(rng, r'["\[\]=.#,]', text, lambda _: ""),
    "a mark more": lambda rng, text: put(rng, r".", text, lambda one: one[0]
                                         + rng.choice("\"[]=.#,'\\{}$\n")),
    "a plain number": lambda rng, text: put(rng, r"(?m)(?<== )\d+$", text, lambda _: rng.choice(
        ("0", "-1", "1", "2", "1.5", "9" * 25, "9" * 400, "nan", '"3"', "true"))),
}  # fmt: skip


# The same in TOML

SAME_UNITS = {"kg": ("t", -3), "m": ("mm", 3), "kN/m": ("N/m", 3), "N/m": ("kN/mm", -6),
              "kg m^2": ("t·m²", -3), "kN s/m": ("N·s/m", 3), "N s/m": ("kN*s/m", -3),
              "Hz": ("kHz", -3), "km/h": ("km / h", 0),
              "N m/rad": ("kN m", -3)}  # fmt: skip


def in_other_units(_, text):
    def new(one):
        unit = (one[2] or "").strip()
        if unit not in SAME_UNITS:
            return one[0]
        other, power = SAME_UNITS[unit]
        return f'"{Decimal(one[1]) * Decimal(10) ** power} {other}"'

    return QUANTITY.sub(new, text)


def reorder_keys(rng, text):
    """Keys of single lines in another order within their tables."""
    parts = re.split(r"(?m)^(?=\[)", text)
    for k, part in enumerate(parts):
        lines = part.split("\n")
        if all(LINE.fullmatch(x) and "[" not in x for x in lines[1:] if x and x[0] != "#"):
            body = lines[1:]
            rng.shuffle(body)
            parts[k] = "\n".join([lines[0], *body]) + "\n"
    return "".join(parts)


SAME_TOML = SAME_LINES | {
    "comments": lambda _, text: LINE.sub(lambda one: one[0] + "  # kg", text),
    "blanks": lambda _, text: LINE.sub(lambda one: f"\n\t{one[2]}\t=  {one[4]} ", text),
    "notation": lambda _, text: QUANTITY.sub(
        lambda one: f'"{Decimal(one[1]):+.20e}{one[2] or ""}"', text
    ),
    "units": in_other_units,
    "quotes": lambda _, text: QUANTITY.sub(lambda one: f"'{one[1]}{one[2] or ''}'", text),
    "order": reorder_keys,
    "commentary": lambda rng, text: put(
        rng, r"(?m)^\[(?!.*notes).*\]$", text, lambda one: one[0] + '\nnote = "as it is"'
    ),
}
