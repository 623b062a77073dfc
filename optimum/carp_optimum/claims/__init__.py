"""Claims that lift a bound: groups of robots that provably cost more together than prices show."""
