# SPDX-License-Identifier: MIT
"""From a recorded sequence to a file of predictions."""
