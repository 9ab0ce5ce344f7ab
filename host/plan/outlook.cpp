#include "gnomon/plan/outlook.h"

#include <cmath>
#include <string>
#include <utility>

#include "gnomon/base/error.h"

namespace gnomon {

namespace {

// As many as tell a mean to a tenth or so: all that a decision by orders of magnitude wants.
constexpr std::uint64_t kCounted = 256;

void require(bool ok, const char* name, double value, const char* range) {
  if (ok) return;
  throw Error(ErrorCode::kInvalidArgument, std::string("outlook option ") + name + " = " +
                                               std::to_string(value) + " is outside its range " + range);
}

}  // namespace

void OutlookOptions::check() const {
  const std::pair<const char*, double> prices[] = {{"baseline_start", baseline_start},
                                                   {"baseline_price", baseline_price},
                                                   {"kind_start", kind_start},
                                                   {"kind_price", kind_price}};
  for (const auto& [name, price] : prices)
    require(price >= 0.0 && std::isfinite(price), name, price, "of finite numbers >= 0");
  require(most_share > 0.0 && most_share <= 1.0, "most_share", most_share, "(0, 1]");
}

Outlook outlook_of(const Bvh& tree, std::span<const Triangle> triangles, std::span<const RaysToCome> rays,
                   const OutlookOptions& options) {
  options.check();
  const auto count = static_cast<double>(triangles.size());
  const OrderedTree in{tree, {}};
  Outlook out;
  out.price = options.baseline_start + options.baseline_price * count;
  for (const RaysToCome& kind : rays) {
    require(kind.expected >= 0.0 && std::isfinite(kind.expected), "expected", kind.expected,
            "of finite numbers >= 0");
    out.price += options.kind_start + options.kind_price * count;
    const std::vector<double> costs = ray_costs(in, triangles, thinned(kind.some, kCounted), kind.query);
    double sum = 0.0;
    for (const double cost : costs) sum += cost;
    if (!costs.empty()) out.work += kind.expected * sum / static_cast<double>(costs.size());
  }
  out.pays = out.price < options.most_share * out.work;
  return out;
}

}  // namespace gnomon
