"""`python -m slam` is `roomsketch`."""

from slam.cli import main

main()
