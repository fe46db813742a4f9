/*
 * Staging the demo's scene.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/stage/stage.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "tsr/host/atomic_file.h"
#include "tsr/host/input_error.h"
#include "tsr/host/pfm.h"
#include "tsr/host/site.h"
#include "tsr/stage/picture.h"

namespace tsr
{

namespace
{

namespace fs = std::filesystem;

constexpr int kFrames = 90;
constexpr int kPeriodMs = 1000;
constexpr int kLightFrame = 30;
constexpr int kObjectFrame = 60;
constexpr double kExposure = 0.8; /* leaves head room for the brighter light */
constexpr double kLightGain = 1.3;
constexpr double kNoiseSigma = 1.5; /* gray levels */

/* Everything is composed at the larger size and halved for the smaller. */
constexpr int kWidth = 320;
constexpr int kHeight = 240;
constexpr int kObjectX = 196; /* left edge in the left view, px at kWidth */
constexpr int kObjectY = 120;
constexpr int kObjectWidth = 84;
constexpr int kObjectHeight = 58;
constexpr int kObjectDisparity = 58; /* in front of all else: the Aloe ends at 53 */

/* Aloe's calibration at its full size of 1282 px, quoted from memory of the
 * Middlebury 2006 page, which opencv-doc does not carry: metres are nominal. */
constexpr double kAloeWidth = 1282;
constexpr double kAloeFocalPx = 3740;
constexpr double kAloeBaselineMm = 160;
constexpr double kAloeOffsetPx = 270;

struct View {
    Picture left;
    Picture right;
    Picture truth; /* px, 0 = unknown */
};

/* Uniform 64-bit numbers: SplitMix64 (Steele, Lea, Flood, OOPSLA 2014). */
class Random
{
  public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    std::uint64_t next()
    {
        std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    /* About normal, mean 0, deviation 1: the sum of four 16-bit uniforms. */
    double normal()
    {
        const std::uint64_t bits = next();
        const double sum =
            static_cast<double>((bits & 0xffffu) + (bits >> 16 & 0xffffu) + (bits >> 32 & 0xffffu) + (bits >> 48));
        /* Variance of one uniform on 0..65535 is 65536^2 / 12. */
        return (sum - 4 * 32767.5) / (65536.0 * std::sqrt(4.0 / 12.0));
    }

  private:
    std::uint64_t state_;
};

View load_aloe(const fs::path &pictures)
{
    const Picture left = from_gray(read_gray_image(pictures / "aloeL.jpg"));
    const Picture right = from_gray(read_gray_image(pictures / "aloeR.jpg"));
    const Picture truth = from_gray16(read_gray16_image(pictures / "aloeGT.png"));
    if (left.width != right.width || left.height != right.height || truth.width != left.width ||
        truth.height != left.height) {
        throw InputError((pictures / "aloeR.jpg").string(), "size", "is not that of aloeL.jpg and aloeGT.png");
    }
    const auto shaped = [](const Picture &picture) { return crop_to_shape(picture, kWidth, kHeight); };
    View view{shrink(shaped(left), kWidth, kHeight), shrink(shaped(right), kWidth, kHeight),
              pick(shaped(truth), kWidth, kHeight)};
    const auto scale = static_cast<float>(static_cast<double>(kWidth) / left.width);
    for (float &disparity : view.truth.pixels) {
        disparity *= scale;
    }
    return view;
}

void put_object(View &view, const Picture &texture)
{
    for (int y = 0; y < kObjectHeight; ++y) {
        for (int x = 0; x < kObjectWidth; ++x) {
            view.left.at(kObjectX + x, kObjectY + y) = texture.at(x, y);
            view.right.at(kObjectX + x - kObjectDisparity, kObjectY + y) = texture.at(x, y);
            view.truth.at(kObjectX + x, kObjectY + y) = kObjectDisparity;
        }
    }
}

/* Light that depends on the row alone falls on the same surface in both views,
 * whatever its depth. */
void brighten_lower_half(Picture &picture)
{
    for (int y = picture.height / 2; y < picture.height; ++y) {
        const double ramp = std::min(1.0, (y - picture.height / 2) / (0.1 * picture.height));
        const auto gain = static_cast<float>(1 + (kLightGain - 1) * ramp);
        for (int x = 0; x < picture.width; ++x) {
            picture.at(x, y) *= gain;
        }
    }
}

GrayImage expose(const Picture &picture, Random &random)
{
    GrayImage image{picture.width, picture.height, {}};
    image.pixels.reserve(picture.pixels.size());
    for (const float value : picture.pixels) {
        const double noisy = kExposure * static_cast<double>(value) + kNoiseSigma * random.normal();
        image.pixels.push_back(static_cast<std::uint8_t>(std::clamp(std::lround(noisy), 0L, 255L)));
    }
    return image;
}

Picture halve(const Picture &picture)
{
    return shrink(picture, picture.width / 2, picture.height / 2);
}

View halve(const View &view)
{
    Picture truth = pick(view.truth, view.truth.width / 2, view.truth.height / 2);
    for (float &disparity : truth.pixels) {
        disparity /= 2;
    }
    return {halve(view.left), halve(view.right), truth};
}

fs::path frame_file(const fs::path &folder, int frame, const char *ending)
{
    const std::string number = std::to_string(frame);
    return folder / (std::string(3 - number.size(), '0') + number + ending);
}

void make_folder(const fs::path &folder)
{
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) {
        throw InputError(folder.string(), "create", error.message());
    }
}

void write_truth(const fs::path &folder, int frame, const Picture &truth)
{
    FloatImage image{truth.width, truth.height, truth.pixels};
    for (float &disparity : image.pixels) {
        disparity = disparity > 0 ? disparity : kFloatInvalid;
    }
    write_pfm(frame_file(folder, frame, ".pfm"), image);
}

void write_times(const fs::path &folder)
{
    std::string text = "file,time_ms\n";
    for (int frame = 0; frame < kFrames; ++frame) {
        text += frame_file({}, frame, ".pgm").string() + "," + std::to_string(frame * kPeriodMs) + "\n";
    }
    write_file_atomically(folder / "times.csv", text);
}

/* The story in one size: folders left<width>, right<width> and truth<width>. */
void write_recordings(const fs::path &out, const View &empty, const View &with_object, std::uint64_t seed)
{
    const std::string size = std::to_string(empty.left.width);
    const fs::path left = out / ("left" + size);
    const fs::path right = out / ("right" + size);
    const fs::path truth = out / ("truth" + size);
    for (const fs::path &folder : {left, right, truth}) {
        make_folder(folder);
    }
    View bright_empty = empty;
    View bright_object = with_object;
    for (View *view : {&bright_empty, &bright_object}) {
        brighten_lower_half(view->left);
        brighten_lower_half(view->right);
    }
    Random random(seed);
    for (int frame = 0; frame < kFrames; ++frame) {
        const View &shown = frame < kLightFrame ? empty : frame < kObjectFrame ? bright_empty : bright_object;
        write_pgm(frame_file(left, frame, ".pgm"), expose(shown.left, random).view());
        write_pgm(frame_file(right, frame, ".pgm"), expose(shown.right, random).view());
    }
    write_times(left);
    write_times(right);
    write_truth(truth, 0, empty.truth);
    write_truth(truth, kObjectFrame, with_object.truth);
}

SiteNode make_node(std::uint16_t id, const char *name, Role role, std::uint16_t parent,
                   const std::array<double, 3> &position_m)
{
    SiteNode node;
    node.id = id;
    node.name = name;
    node.role = role;
    node.parent = parent;
    node.position_m = position_m;
    node.watch_period_ms = kPeriodMs;
    return node;
}

SitePair make_pair(const char *name, std::uint16_t lead, std::uint16_t wing, int width, double x_m)
{
    const double scale = width / kAloeWidth;
    SitePair pair;
    pair.name = name;
    pair.lead = lead;
    pair.wing = wing;
    pair.width = width;
    pair.height = width * kHeight / kWidth;
    pair.disparities = width / 5;
    pair.d0_px = std::round(kAloeOffsetPx * scale * 16) / 16;
    pair.focal_px = kAloeFocalPx * scale;
    pair.baseline_mm = kAloeBaselineMm;
    pair.principal_px = {(pair.width - 1) / 2.0, (pair.height - 1) / 2.0};
    /* Looking along the site's y axis: camera z to site y, camera y down. */
    pair.left.rotation = {1, 0, 0, 0, 0, 1, 0, -1, 0};
    pair.left.position_m = {x_m, 0, 1.2};
    pair.truth = "truth" + std::to_string(width);
    return pair;
}

void write_stage_site(const fs::path &file, std::uint64_t seed)
{
    Site site;
    site.file = file;
    site.name = "aloe";
    site.seed = seed;
    site.radio.frame_loss = 0.02;
    site.nodes = {make_node(1, "gateway", Role::gateway, kNodeNone, {0, -18, 2}),
                  make_node(2, "relay", Role::relay, 1, {0, -8, 2.5}),
                  make_node(3, "left bench", Role::lead, 2, {-0.3, 0, 1.2}),
                  make_node(4, "left bench wing", Role::wing, 3, {-0.14, 0, 1.2}),
                  make_node(5, "right bench", Role::binocular, 2, {0.3, 0, 1.2})};
    site.nodes[2].frames = "left160";
    site.nodes[3].frames = "right160";
    site.nodes[4].frames = "left320";
    site.nodes[4].frames_right = "right320";
    site.pairs = {make_pair("two boards", 3, 4, 160, -0.3), make_pair("binocular", 5, kNodeNone, 320, 0.3)};
    check_site(site);
    write_site(file, site);
}

} // namespace

void write_stage(const StageOptions &options)
{
    const View empty = load_aloe(options.pictures);
    View with_object = empty;
    const Picture box = from_gray(read_gray_image(options.pictures / "box.png"));
    put_object(with_object, shrink(crop_to_shape(box, kObjectWidth, kObjectHeight), kObjectWidth, kObjectHeight));
    make_folder(options.out);
    write_recordings(options.out, empty, with_object, options.seed);
    write_recordings(options.out, halve(empty), halve(with_object), options.seed + 1);
    write_stage_site(options.out / "site.toml", options.seed);
}

} // namespace tsr
