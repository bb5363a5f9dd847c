// What `scripts/check lint` holds the pages' scripts and their tests to: eslint's recommended rules and a few more.
import { createRequire } from "node:module";
import { join } from "node:path";

const require = createRequire(join(process.env.AFTERSHADE_PAGE_MODULES ?? join(process.cwd(), "build/page-modules"), "/"));
const globals = require("globals");

export default [
  require("@eslint/js").configs.recommended,
  {
    languageOptions: { globals: { ...globals.browser, ...globals.node, axe: "readonly" } },
    rules: {
      eqeqeq: "error",
      "no-var": "error",
      "prefer-const": "error",
      "no-unused-vars": ["error", { args: "none", ignoreRestSiblings: true }],
    },
  },
  // The report is one file of these, which share their names.
  { files: ["framework/golden/report_page/*.js"], rules: { "no-undef": "off", "no-unused-vars": "off" } },
];
