"""Make the helpers of the core's tests known to the planners' tests."""

from pathlib import Path
import sys

sys.path.append(str(Path(__file__).parents[1] / 'core'))
