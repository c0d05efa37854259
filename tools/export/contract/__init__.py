# SPDX-License-Identifier: MIT
"""The model contract of libunisim in Python: what every exported model takes and gives."""
