"""The live page: the steady state of a Hertz contact, calculated in the browser."""

from partialslip.study.live.page import live_page as live_page
