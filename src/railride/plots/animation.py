"""A mode in motion: the car body and the bogies over one period, as a GIF."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from railride.errors import InputError
from railride.files import write_bytes
from railride.plots import canvas
from railride.plots.modes import draw, mode_shape, refuse_others, title

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from PIL.Image import Image

    from railride.modal import Mode
    from railride.vehicle import VehicleModel

DPI = 100
FRAME_MS = 60  # of one frame: a multiple of GIF's 10 ms
MOST_FRAMES = 500
CREEP = 3.0  # time constants of a real eigenvalue that are shown


def animate_mode(
    model: VehicleModel, mode: Mode, path: str | Path, *, frames: int = 24, decay: bool = False
) -> None:
    r"""Write one period of a mode, as a GIF that goes round and round.

    .. math:: q(t) = \mathrm{Re}(\varphi\, e^{i \omega t}), \qquad \omega = \mathrm{Im}\,\lambda,
              \qquad 0 \le t < 2\pi/\omega

    The shape is complex: what leads or lags in phase is seen to. A real eigenvalue has no period
    and creeps back, φ e^{λt}, over three of its time constants.

    Parameters
    ----------
    mode : one of :func:`railride.modal.modes` of this model.
    path : the file, ``.gif``, written as a whole or not at all; the same mode gives the same bytes.
    frames : how many pictures to a period, 2 to 500; each is shown for 60 ms.
    decay : whether the amplitude falls as the mode is damped, e^{λt}.

    Raises
    ------
    InputError : another suffix, a file that cannot be written, a number of frames out of range, a
        mode of another model.
    """
    from PIL.Image import Dither

    check_animation(path)
    if isinstance(frames, bool) or int(frames) != frames or not 2 <= frames <= MOST_FRAMES:
        raise InputError(f"frames: found {frames}; expected a whole number from 2 to {MOST_FRAMES}")
    refuse_others(model, [mode])
    pictures = _pictures(model, mode, int(frames), decay=decay)
    # One palette for all frames, or their colours would flicker.
    palette = pictures[0].quantize(colors=128)
    first, *others = (p.quantize(palette=palette, dither=Dither.NONE) for p in pictures)
    content = BytesIO()
    first.save(content, format="GIF", save_all=True, append_images=others, duration=FRAME_MS,
               loop=0, optimize=False, disposal=1)  # fmt: skip
    write_bytes(path, content.getvalue())


def check_animation(path: str | Path) -> None:
    """Raise InputError for the name of a file that does not end in ``.gif``.

    >>> check_animation("heave.GIF")
    """
    suffix = Path(path).suffix
    if suffix.lower() != ".gif":
        found = f"the suffix {suffix!r}" if suffix else "no suffix"
        raise InputError(f"{str(path)!r}: found {found}; expected .gif, the only kind of animation")


def _pictures(model: VehicleModel, mode: Mode, frames: int, *, decay: bool) -> list[Image]:
    """One picture for each instant, of one size and place; the time in each."""
    root = mode.eigenvalue
    length = 2 * np.pi / root.imag if root.imag else CREEP / abs(root)
    figure = canvas.new_figure(7.2, 3.4)
    figure.set_dpi(DPI)
    ax = figure.add_subplot()
    pictures: list[Image] = []
    for time in np.arange(frames) / frames * length:
        ax.clear()
        growth = root if decay or not root.imag else 1j * root.imag
        draw(ax, model.vehicle, mode_shape(model, mode, np.exp(growth * time)))
        ax.set_title(title(mode), **canvas.TITLE)
        ax.set_title(f"t = {_time(float(time), length)}", loc="right", fontsize="medium",
                     family="monospace")  # fmt: skip
        ax.set_xlabel("x, forward of the body's middle [m]")
        if not pictures:
            figure.legend(*ax.get_legend_handles_labels(), loc="outside lower center", ncols=4,
                          frameon=False, fontsize="small")  # fmt: skip
            figure.draw_without_rendering()
            figure.set_layout_engine("none")  # what has its place keeps it
        pictures.append(_picture(figure))
    return pictures


def _time(time: float, length: float) -> str:
    """A time in the unit that suits the longest, of constant width."""
    unit, factor = ("s", 1.0) if length >= 10 else ("ms", 1e3)
    digits = max(0, 3 - int(np.floor(np.log10(length * factor))))
    width = len(f"{length * factor:.{digits}f}")
    return f"{time * factor:{width}.{digits}f} {unit}"


def _picture(figure: Figure) -> Image:
    """The figure as it is now."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from PIL.Image import fromarray

    drawn: Any = FigureCanvasAgg(figure)
    drawn.draw()
    return fromarray(np.asarray(drawn.buffer_rgba())).convert("RGB")
