"""The check-up names what is missing and the exact command that mends it."""

import pytest

from frontend.registration import RegistrationError
from slam import doctor


def test_everything_needed_is_in_order_where_the_tests_run() -> None:
    assert [finding.subject for finding in doctor.examine() if finding.needed and not finding.in_order] == []


def test_a_missing_library_is_named_with_its_remedy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(doctor, "SYSTEM_LIBRARIES", {"libnobody.so.9": "libnobody9"})
    monkeypatch.setattr("sys.platform", "linux")
    finding = doctor.examine()[-1]
    assert not finding.in_order
    assert not finding.needed
    assert "apt-get install libnobody9" in finding.says


def test_a_registration_that_cannot_load_says_why_and_the_rest_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse() -> None:
        raise RegistrationError("open3d cannot be loaded (libGL.so.1)")

    monkeypatch.setattr(doctor, "load_open3d", refuse)
    finding = next(finding for finding in doctor.examine() if finding.subject == "open3d")
    assert finding == doctor.Finding("open3d", False, False, "open3d cannot be loaded (libGL.so.1)")


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
