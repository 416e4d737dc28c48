// A click on a column's head sorts the table by it; a second click turns the order round.
// SPDX-License-Identifier: Apache-2.0
for (const table of document.querySelectorAll("table.sortable"))
  table.querySelectorAll("th").forEach((head, column) =>
    head.addEventListener("click", () => {
      const key = (row) => row.cells[column].dataset.sort ?? row.cells[column].textContent;
      const compare = (a, b) => {
        const x = key(a), y = key(b), difference = Number(x) - Number(y);
        return Number.isNaN(difference) ? x.localeCompare(y) : difference;
      };
      const up = head.dataset.order !== "up";
      table.querySelectorAll("th").forEach((other) => delete other.dataset.order);
      head.dataset.order = up ? "up" : "down";
      const rows = [...table.tBodies[0].rows].sort((a, b) => (up ? 1 : -1) * compare(a, b));
      table.tBodies[0].append(...rows);
    }));
