"""Reports of a run: terminal tables, files, HTML page and notebook cells."""

from partialslip.report.files import write_run as write_run
from partialslip.report.record import Record as Record
from partialslip.report.record import load_result as load_result
from partialslip.report.record import record as record
from partialslip.report.terminal import print_run as print_run
