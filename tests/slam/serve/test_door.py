"""The door: free ports are found, taken ones are said to be, and the address is one a browser understands."""

import pytest

from slam.serve.door import DoorError, address_of, open_door


def test_a_taken_port_says_what_to_do() -> None:
    with open_door("127.0.0.1", 0) as door:
        port = door.getsockname()[1]
        with pytest.raises(DoorError, match=rf"port {port} on 127.0.0.1 cannot be opened .*--port 0 for a free one"):
            open_door("127.0.0.1", port)


def test_a_host_that_is_not_here_says_so() -> None:
    with pytest.raises(DoorError, match=r"port 0 on 192\.0\.2\.1 cannot be opened"):
        open_door("192.0.2.1", 0)


@pytest.mark.parametrize(
    ("host", "shown"),
    [("127.0.0.1", "127.0.0.1"), ("0.0.0.0", "127.0.0.1"), ("::1", "[::1]"), ("::", "[::1]"), ("robot", "robot")],
)
def test_the_address_is_one_to_type_on_this_machine(host: str, shown: str) -> None:
    with open_door("127.0.0.1", 0) as door:
        assert address_of(door, host) == f"http://{shown}:{door.getsockname()[1]}/"
