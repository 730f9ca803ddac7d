#include "rules/cause_rows.hpp"

namespace edsc {

std::span<const CauseRow> cause_rows() {
  using enum CauseReach;
  static const std::vector<CauseRow> rows{
      {"shifted-data-types",
       file,
       {"data-type",
        "standard-data-type",
        "complex-data-type",
        "profile-data-type",
        "sub-index-0-type",
        "array-data-type",
        "number-format",
        "number-range",
        "number-spelling",
        "octet-string",
        "string-quotes",
        "domain-value",
        "default-outside-limits",
        "limits-order",
        "pdo-length",
        "pdo-variable-length",
        "pdo-boolean-byte",
        "pdo-size",
        "pdo-granularity",
        "mapping-of-no-length",
        "sub-index-0-value",
        "meaning-bits",
        "meaning-value",
        "never-writable",
        "pdo-mapping-gap"}},
      // Certain: the others only look decimal.
      {"sub-index-base",
       file,
       {"sub-index-base", "section-name", "sub-number", "sub-index-0-value", "standard-sub-index",
        "standard-sub-index-missing", "pdo-mapping-gap", "pdo-mapping-count", "pdo-object", "compact-entry"},
       Severity::error},
      {"sub-index-base", object, {"sub-number", "sub-index-0-value", "pdo-mapping-gap", "pdo-mapping-count"}},
      {"cob-id-node-id", file, {"default-sdo-cob-id"}},
      {"cob-id-node-id", object, {"cob-id-twice", "cob-id-restricted"}},
      {"no-device-info", file, {"pdo-count", "baud-rates"}},
      {"data-type",
       object,
       {"standard-sub-index-missing", "no-sub-objects", "sub-index-0", "sub-index-0-value", "sub-index-0-type",
        "array-data-type", "pdo-variable-length", "mapping-of-no-length", "pdo-length", "number-format",
        "profile-data-type"}},
      {"complex-data-type", object, {"sub-index-0", "pdo-mapping-gap", "never-writable", "sub-index-0-value"}},
      {"number-format", object, {"sub-index-0-value", "pdo-mapping-gap", "cob-id-missing"}},
      {"access-type", object, {"never-writable", "sub-index-0-access", "standard-access", "pdo-mapping-gap"}},
      {"pdo-mapping-gap", object, {"never-writable", "sub-index-0-value"}},
      {"sub-number", object, {"sub-index-0-value", "pdo-pair"}},
      {"compact-sub-obj", object, {"sub-index-0-access", "no-sub-objects", "sub-number"}},
      {"pdo-pair", object, {"never-writable"}},
  };
  return rows;
}

}  // namespace edsc
