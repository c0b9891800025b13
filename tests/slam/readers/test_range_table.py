"""Range tables: bearings from the header, no echo told apart from nonsense."""

import numpy as np
import pytest

from frontend.scan import Sensor
from slam.readers.range_table import parse_header, parse_row
from slam.readers.sieve import LineError

SONAR = Sensor("sonar_infrared", 10.7)
HEADER = "time,x,y,heading,range@-90,range@0,range@90.5,infrared@-90,infrared@0,infrared@90.5"


def test_a_row_becomes_a_scan() -> None:
    scan = parse_row("1.5,0.1,0.2,0.3,1.0,,inf,31,30,40", parse_header(HEADER), SONAR)
    assert np.allclose(np.degrees(scan.bearings), [-90, 0, 90.5])
    assert np.array_equal(scan.ranges, [1.0, np.inf, np.inf])
    assert scan.infrared is not None
    assert scan.infrared.tolist() == [31, 30, 40]
    assert np.array_equal(scan.odometry, [0.1, 0.2, 0.3])
    assert scan.time == 1.5


def test_a_reading_that_failed_is_no_silence() -> None:
    scan = parse_row("1,0,0,0,nan,,3.0", parse_header("time,x,y,heading,range@-90,range@0,range@90"), SONAR)
    assert np.array_equal(scan.ranges, [np.nan, np.inf, 3.0], equal_nan=True)


@pytest.mark.parametrize(
    "spelled",
    [
        ("time;x;y;heading;range@-0,5;range@0", "1,5;0,1;0;0;1,25;"),
        ("time\tx\ty\theading\trange@-0.5\trange@0", "1.5\t0.1\t0\t0\t1.25\t"),
        ("time, x, y, heading, range@-0.5, range@0", "1.5, 0.1, 0, 0, 1.25, "),
        ('"time","x","y","heading","range@-0.5","range@0"', '"1.5","0.1","0","0","1.25",""'),
    ],
)
def test_a_table_may_be_spelled_as_spreadsheets_do(spelled: tuple[str, str]) -> None:
    header, row = spelled
    scan = parse_row(row, parse_header(header), SONAR)
    assert np.allclose(np.degrees(scan.bearings), [-0.5, 0])
    assert np.array_equal(scan.ranges, [1.25, np.inf])
    assert (scan.time, *scan.odometry) == (1.5, 0.1, 0, 0)


@pytest.mark.parametrize(
    ("row", "says"),
    [
        ("1,0,0,0,1.0,2.0", "3 bearings"),
        ("1,0,0,0,1.0,-2.0,3.0", "range 2 of 3 is negative"),
        ("1,0,0,0,1.0,2.0,0", "range 3 of 3 is zero"),
        ("1,0,0,0,1.0,2.0,3577", "range 3 of 3 is 3577 m, but no sensor for rooms reaches 1000 m: ranges are metres"),
        ("1,inf,0,0,1.0,2.0,3.0", "x is not finite"),
        ("1,0,0,0,1.0,2.0,3.O", "'3.O' is not a number"),
    ],
)
def test_a_row_that_cannot_be_is_refused_with_its_numbers(row: str, says: str) -> None:
    header = parse_header("time,x,y,heading,range@-90,range@0,range@90")
    with pytest.raises(LineError, match=says):
        parse_row(row, header, SONAR)


def test_infrared_codes_have_two_digits() -> None:
    with pytest.raises(LineError, match="infrared code"):
        parse_row("1,0,0,0,1,1,1,31,300,40", parse_header(HEADER), SONAR)


@pytest.mark.parametrize(
    ("header", "says"),
    [
        ("t,x,y,heading,range@0", "should begin 'time,x,y,heading'"),
        ("time,range@0", "where no wheels were read, x, y and heading are 0"),
        ("time,x,y,heading,depth@0", "neither range@DEGREES"),
        ("time,x,y,heading,range@0,range@-1", "do not increase"),
        ("time,x,y,heading,range@0,range@361", "within one turn"),
        ("time,x,y,heading,range@0,range@1,infrared@0", "1 infrared columns do not repeat"),
        ("time,x,y,heading", "0 bearings"),
    ],
)
def test_a_header_that_names_no_geometry_is_refused(header: str, says: str) -> None:
    with pytest.raises(LineError, match=says):
        parse_header(header)
