"""The face: command line, protocol, other tools' formats."""
