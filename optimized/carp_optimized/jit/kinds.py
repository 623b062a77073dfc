"""The kinds of arrays: whole numbers, in one dimension or two, which compiled functions take, and truths."""

from typing import Annotated, TypeAlias

import numpy as np
import numpy.typing as npt

Ints: TypeAlias = npt.NDArray[np.int32]
Longs: TypeAlias = npt.NDArray[np.int64]
Flags: TypeAlias = npt.NDArray[np.bool_]
Numbers: TypeAlias = npt.NDArray[np.uint64]
IntTable: TypeAlias = Annotated[npt.NDArray[np.int32], 2]
ShortTable: TypeAlias = Annotated[npt.NDArray[np.int16], 2]
LongTable: TypeAlias = Annotated[npt.NDArray[np.int64], 2]
