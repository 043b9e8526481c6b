"""Arrays as datasets of xarray, with the units of the CF conventions; as dictionaries if xarray is not installed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import numpy as np
import numpy.typing as npt

from ._optional import Columns

if TYPE_CHECKING:
    import xarray as xr

_LONG_NAMES = {
    "time_star": "dimensionless time t*",
    "time_s": "time since the start of the drive",
    "drive_time_star": "t* of the drive, which pauses while blocks slide",
    "drive_displacement_m": "displacement of the drive",
    "mu_star": "friction coefficient over mu_s",
    "friction_coefficient": "friction coefficient F_T/F_N",
    "mu_lateral_star": "mu* across the drive",
    "friction_force_n": "friction along the drive",
    "lateral_force_n": "friction across the drive",
    "torque_n_m": "torque of friction",
    "sliding_percent": "share of sliding blocks N*",
    "work_j": "work of the drive since the start",
    "kinetic_energy_j": "kinetic energy",
    "lattice_energy_j": "energy of the springs between blocks",
    "drive_spring_energy_j": "energy of the drive springs",
    "friction_loss_j": "lost to friction since the start",
    "damping_loss_j": "lost to damping since the start",
    "viscous_loss_j": "lost to the dampers between blocks since the start",
    "contact_spring_energy_j": "energy of the springs in contact",
    "foundation_energy_j": "energy of the foundation under an upright sheet",
    "broken_spring_loss_j": "lost with springs that broke since the start",
    "weakening_loss_j": "lost to friction as strength falls with slip since the start",
    "mean_state_star": "mean state of the contacts",
}
_UNITS = {"_n_m": "N m", "_percent": "%", "_m": "m", "_s": "s", "_n": "N", "_j": "J"}


def _attributes(name: str) -> dict[str, str]:
    unit = next((unit for ending, unit in _UNITS.items() if name.endswith(ending)), "1")
    return {"units": unit, "long_name": _LONG_NAMES.get(name, name.replace("_", " "))}


def read_only(array: npt.ArrayLike) -> npt.NDArray[Any]:
    """A read-only array, because all callers get the same one."""
    shared = np.asarray(array)
    shared.flags.writeable = False
    return shared


def _dataset(variables: dict[str, Any], coordinates: dict[str, Any]) -> xr.Dataset:
    for named in (variables, coordinates):
        for name, (dimensions, array, attributes) in named.items():
            named[name] = dimensions, read_only(array), attributes
    try:
        import xarray
    except ImportError:
        plain = {name: array for name, (_, array, _) in {**coordinates, **variables}.items()}
        return cast("xr.Dataset", Columns(plain))
    return xarray.Dataset(variables, coordinates)


def table(columns: dict[str, Any], index: str = "time_star") -> xr.Dataset:
    """Columns of equal length; the index is their coordinate."""
    variables = {name: (index, values, _attributes(name)) for name, values in columns.items()}
    return _dataset(variables, {index: variables.pop(index)})


def fields(arrays: dict[str, Any]) -> xr.Dataset:
    """The content of `fields.nc`."""
    instants, time_star = arrays["instants"], arrays["instants"]["time_star"]
    plane = ("y", "x")

    def of_plane(name: str, long_name: str) -> tuple[Any, Any, dict[str, str]]:
        return plane, arrays[name], {"units": "1", "long_name": long_name}

    variables: dict[str, Any] = {
        name: (("time", *plane), values, {"units": unit, "long_name": long_name})
        for name, (values, unit, long_name) in arrays["fields"].items()
    }
    variables |= {
        "textured": of_plane("textured", "texture"),
        "mu_static": of_plane("mu_static", "static friction coefficient"),
        "mu_kinetic": of_plane("mu_kinetic", "kinetic friction coefficient"),
        "first_slip_time_star": of_plane("first_slip_time_star", "time t* of the first slip"),
    }
    time = {"units": "s", "long_name": "time since the start of the drive"}
    coordinates: dict[str, Any] = {
        "time": ("time", time_star * arrays["time_unit_s"], time),
        "time_star": ("time", time_star, _attributes("time_star")),
        "step": ("time", instants["step"], {"units": "1", "long_name": "number of the time step"}),
        "instant": ("time", instants["instant"], {"long_name": "name of the instant"}),
        "y": ("y", arrays["y"], {"units": "m", "long_name": "y of the block centre"}),
        "x": ("x", arrays["x"], {"units": "m", "long_name": "x of the block centre"}),
    }
    return _dataset(variables, coordinates)


def kymograph(arrays: dict[str, Any], time_unit_s: float) -> xr.Dataset:
    """The content of `kymograph.nc`."""
    time_star = arrays["time_star"]
    share = {"units": "1", "long_name": "share of the blocks in contact that slide"}
    coordinates: dict[str, Any] = {
        "time": ("time", time_star * time_unit_s, {"units": "s", "long_name": "time since the start of the drive"}),
        "time_star": ("time", time_star, _attributes("time_star")),
        "place": ("place", arrays["place"], {"units": "m", "long_name": "place along the drive"}),
    }
    return _dataset({"sliding_share": (("time", "place"), arrays["sliding_share"], share)}, coordinates)
