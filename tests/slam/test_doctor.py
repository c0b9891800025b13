"""The check-up names what is missing and the exact command that mends it."""

import re
import tomllib
from pathlib import Path

import pytest

from frontend.registration import RegistrationError
from slam import doctor


def found(subject: str) -> doctor.Finding:
    return next(finding for finding in doctor.examine() if finding.subject == subject)


def names(requirements: list[str]) -> set[str]:
    return {re.split(r"[^\w-]", line)[0] for line in requirements}


def test_everything_needed_is_in_order_where_the_tests_run() -> None:
    assert [finding.subject for finding in doctor.examine() if finding.needed and not finding.in_order] == []


def test_a_missing_library_is_named_with_its_remedy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(doctor, "SYSTEM_LIBRARIES", {"libnobody.so.9": "libnobody9"})
    monkeypatch.setattr("sys.platform", "linux")
    finding = found("libraries of open3d")
    assert not finding.in_order
    assert not finding.needed
    assert "apt-get install libnobody9" in finding.says


def test_a_registration_that_cannot_load_says_why_and_the_rest_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse() -> None:
        raise RegistrationError("open3d cannot be loaded (libGL.so.1)")

    monkeypatch.setattr(doctor, "load_open3d", refuse)
    assert found("open3d") == doctor.Finding("open3d", False, False, "open3d cannot be loaded (libGL.so.1)")


def test_missing_libraries_are_fetched_only_by_root_and_after_a_fresh_list(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(doctor, "missing_system_libraries", lambda: ["libgl1"])
    monkeypatch.setattr("shutil.which", lambda _: "/usr/bin/apt-get")
    commands: list[list[str]] = []

    def no_lists_yet(command: list[str]) -> int:
        commands.append(command)
        return 100 if len(commands) == 1 else 0

    monkeypatch.setattr("os.geteuid", lambda: 1000)
    assert not doctor.install_system_libraries(no_lists_yet)
    monkeypatch.setattr("os.geteuid", lambda: 0)
    assert doctor.install_system_libraries(no_lists_yet)
    assert [command[1] for command in commands] == ["install", "update", "install"]
    assert commands[0][-1] == "libgl1"


def test_everything_the_package_asks_for_is_looked_at() -> None:
    project = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text())["project"]
    brought = {*doctor.DISTRIBUTIONS, *doctor.REGISTRATION_DISTRIBUTIONS, "libusb-package"}
    assert names(project["dependencies"]) == brought
    for extra in doctor.EXTRAS:
        assert names(project["optional-dependencies"][extra.name]) == set(extra.modules)
    assert {extra.name for extra in doctor.EXTRAS} == project["optional-dependencies"].keys() - {"dev"}


@pytest.mark.parametrize("extra", doctor.EXTRAS, ids=lambda extra: extra.name)
def test_a_missing_extra_is_named_with_what_it_serves_and_its_command(
    extra: doctor.Extra, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(doctor, "EXTRAS", (doctor.Extra(extra.name, {"no-such-thing": "no_such"}, extra.serves),))
    finding = found(f"extra [{extra.name}]")
    assert not finding.in_order
    assert not finding.needed
    assert extra.serves in finding.says
    assert f"pip install 'roomsketch[{extra.name}]'" in finding.says


def test_a_broken_extra_says_why_it_cannot_be_imported(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(module: str) -> None:
        raise ImportError(f"no {module} for this processor")

    monkeypatch.setattr(doctor, "import_module", refuse)
    finding = found("extra [cad]")
    assert not finding.in_order
    assert "no ezdxf for this processor" in finding.says
    assert "--force-reinstall" in finding.says


def test_the_data_folder_is_told_by_what_it_holds(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ROOMSKETCH_DATA", raising=False)
    assert "export ROOMSKETCH_DATA=FOLDER" in found("ROOMSKETCH_DATA").says
    monkeypatch.setenv("ROOMSKETCH_DATA", str(tmp_path / "attic"))
    assert f"{tmp_path / 'attic'} is no folder" in found("ROOMSKETCH_DATA").says
    monkeypatch.setenv("ROOMSKETCH_DATA", str(tmp_path))
    assert "holds no folder" in found("ROOMSKETCH_DATA").says
    (tmp_path / "intel").mkdir()
    assert found("ROOMSKETCH_DATA") == doctor.Finding("ROOMSKETCH_DATA", True, False, f"{tmp_path}: intel")
    assert "flynn_basement" in found("datasets").says
