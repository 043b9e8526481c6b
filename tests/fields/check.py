"""Reads the fields files of crates/slipfront-run/tests/run/fields.rs with netCDF-C, by way of xarray, and with the reader of
ParaView, vtkNetCDFCFReader, and compares them with the values that were written; run.sh calls it.

    check.py FOLDER [COPY]

The small file and the kymograph must be byte for byte what netCDF-C writes of the same contents. COPY, if given, becomes that file as netCDF-C
writes it with 64-bit data: netcdf-c-64-bit-data.nc, which tests read, was made so.
"""

import sys
from pathlib import Path

import netCDF4
import numpy as np
import xarray as xr
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkFiltersCore import vtkArrayCalculator
from vtkmodules.vtkIONetCDF import vtkNetCDFCFReader

FIELDS = ["contact_stress_star", "traction"]
# Lengths along x and y, and the ranges of rows that are written.
SMALL = (7, 5, [(0, 5)])
LARGE = (30_001, 17_999, [(0, 1), (9_000, 9_003), (17_997, 17_999)])


def value(array, row, column):
    return (31 * row + 17 * column + 1000 * array) % 4096 / 8


def known(name, instant, row, column):
    """The values that were written for a block."""
    if name == "textured":
        return (row + column) % 3 == 0
    if name == "first_slip_time_star":
        return np.where((row + 2 * column) % 5 == 0, np.nan, value(2, row, column))
    if name in FIELDS:
        return value(10 * (instant + 1) + FIELDS.index(name), row, column)
    return value(["mu_static", "mu_kinetic"].index(name), row, column)


def expect(what, found, wanted):
    if not np.array_equal(found, wanted, equal_nan=np.asarray(wanted).dtype.kind == "f"):
        sys.exit(f"{what}: {str(found)[:2000]} where {str(wanted)[:2000]} is wanted")


def check_netcdf(path, nx, ny, written, model):
    with netCDF4.Dataset(path) as file:
        expect(f"{path}: format", file.data_model, model)
    with xr.open_dataset(path, engine="netcdf4") as data:
        expect("dimensions", dict(data.sizes), {"x": nx, "y": ny, "time": 2})
        expect("x", data.x.values, (np.arange(nx) + 0.5) * 0.25)
        expect("y", data.y.values, (np.arange(ny) + 0.5) * 0.25)
        expect("time", data.time.values, [0.75, 1.5])
        expect("time_star", data.time_star.values, [1.5, 3.0])
        expect("step", data.step.values, [15.0, 30.0])
        expect("instant", data.instant.astype(str).values, ["A", "BC"])
        expect("unit", data.traction.attrs["units"], "Pa")
        blocks = [name for name in data.variables if data[name].dims[-2:] == ("y", "x")]
        expect("variables", sorted(blocks), sorted(["textured", "mu_static", "mu_kinetic", "first_slip_time_star", *FIELDS]))
        for start, end in written:
            row, column = np.ogrid[start:end, :nx]
            for name in blocks:
                rows = data[name].isel(y=slice(start, end))
                for instant in range(2):
                    found = rows.isel(time=instant) if "time" in rows.dims else rows
                    expect(f"{name}, rows from {start}", found.values, known(name, instant, row, column))


def check_vtk(path, nx, ny, written):
    said = vtkStringOutputWindow()
    vtkOutputWindow.SetInstance(said)
    reader = vtkNetCDFCFReader()
    reader.SetFileName(str(path))
    reader.UpdateMetaData()
    reader.SetDimensions("(y, x)")
    for instant in range(2):
        for start, end in written:
            # Points of x, y and z: these rows alone are read.
            reader.UpdateTimeStep(0.75 * (instant + 1), -1, 1, 0, (0, nx - 1, start, end - 1, 0, 0))
            output = reader.GetOutput()
            expect("extent", output.GetExtent(), (0, nx - 1, start, end - 1, 0, 0))
            expect("first point", output.GetPoint(0), (0.125, (start + 0.5) * 0.25, 0.0))
            points = output.GetPointData()
            names = [points.GetArrayName(k) for k in range(points.GetNumberOfArrays())]
            expect("arrays", sorted(names), sorted(["textured", "mu_static", "mu_kinetic", "first_slip_time_star", *FIELDS]))
            row, column = np.ogrid[start:end, :nx]
            for name in names:
                found = vtk_to_numpy(points.GetArray(name)).reshape(end - start, nx)
                expect(f"{name}, rows from {start}", found, known(name, instant, row, column))
            check_vector(output, start, row, column, instant)
    expect("what the reader says", said.GetOutput(), "")


def check_vector(output, start, row, column, instant):
    """Two fields become one vector by the expression of the guide."""
    calculator = vtkArrayCalculator()
    calculator.SetInputData(output)
    for name in FIELDS:
        calculator.AddScalarArrayName(name)
    calculator.SetFunction(f"{FIELDS[0]}*iHat + {FIELDS[1]}*jHat")
    calculator.SetResultArrayName("vector")
    calculator.Update()
    found = vtk_to_numpy(calculator.GetOutput().GetPointData().GetArray("vector"))
    wanted = [known(name, instant, row, column).ravel() for name in FIELDS]
    expect(f"the vector, rows from {start}", found, np.stack([*wanted, np.zeros(found.shape[0])], axis=1))


def check_kymograph(path):
    """Checks the run in fields.rs: 30 columns of 4 blocks of 0.5 um, one of them without contact."""
    with xr.open_dataset(path, engine="netcdf4") as data:
        expect("places", data.sizes["place"], 30)
        expect("place", np.round(data.place.values * 1e9), 500.0 * (np.arange(30) + 0.5))
        expect("blocks in contact", data.blocks_in_contact.values, np.where(np.arange(30) == 7, 0.0, 4.0))
        expect("units", [data[name].attrs["units"] for name in ("place", "sliding_share")], ["m", "1"])
        share = data.sliding_share.dropna("place", how="all")
        expect("bins with contact", share.sizes["place"], 29)
        expect("the first share", share[0].max().item(), 0.0)
        expect("the largest share", share.max("time").min().item(), 1.0)
        expect("time", np.diff(data.time_star.values).min() > 0, True)


def copy(source, target, model):
    """The same contents, written by netCDF-C."""
    with netCDF4.Dataset(source) as old, netCDF4.Dataset(target, "w", format=model) as new:
        for name, dimension in old.dimensions.items():
            new.createDimension(name, None if dimension.isunlimited() else len(dimension))
        new.setncatts({name: old.getncattr(name) for name in old.ncattrs()})
        for name, variable in old.variables.items():
            made = new.createVariable(name, variable.dtype, variable.dimensions)
            made.setncatts({key: variable.getncattr(key) for key in variable.ncattrs()})
            for file in (variable, made):
                file.set_auto_maskandscale(False)
            made[:] = variable[:]


def main(folder, target=None):
    small, large = folder / "small.nc", folder / "large.nc"
    check_netcdf(small, *SMALL, "NETCDF3_64BIT_OFFSET")
    check_netcdf(large, *LARGE, "NETCDF3_64BIT_DATA")
    check_kymograph(folder / "kymograph.nc")
    check_vtk(small, *SMALL)
    check_vtk(large, *LARGE)
    again = folder / "copy.nc"
    for written in (small, folder / "kymograph.nc"):
        copy(written, again, "NETCDF3_64BIT_OFFSET")
        expect(f"the bytes of {written.name}", written.read_bytes(), again.read_bytes())
    if target:
        copy(small, target, "NETCDF3_64BIT_DATA")
    print("netCDF-C and VTK read what was written")


main(*map(Path, sys.argv[1:]))
