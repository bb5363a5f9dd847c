// Passes: what they may say, and what is wrong with the rest.
#include "tests/effect/broken_manifests.h"

namespace aftershade {
namespace {

using test::demo_manifest;
using test::EffectFolder;
using test::Lines;
using test::Sections;

/// Resources of every kind, and a first pass that fills most of them.
Sections workshop(const std::string& passes) {
    return {
        {test::kTextures, R"("textures": {
            "small": {"format": "rgba16f", "scale": 0.5, "doc": "."},
            "pyramid": {"format": "rg32f", "mips": 4, "clear": 0, "doc": "."},
            "stack": {"format": "rgba8", "layers": 3, "clear": 0, "doc": "."},
            "ids": {"format": "r32ui", "clear": 0, "doc": "."},
            "chain": {"format": "r16f", "mips": "auto", "clear": 0, "doc": "."}})"},
        {test::kMore, R"("buffers": {
            "list": {"element": "uint", "per": "pixel", "doc": "."},
            "args": {"element": "uint", "count": 4, "indirect": true, "doc": "."},
            "sums": {"element": "vec4", "count": 8, "clear": 0, "doc": "."}})"},
        {test::kParams, R"("params": {
            "gain": {"type": "float", "unit": "m", "default": 1, "min": 0, "max": 9, "doc": "."},
            "mode": {"type": "enum", "values": ["fast", "good"], "default": "fast", "doc": "."},
            "turns": {"type": "int", "default": 2, "min": 0, "max": 4, "doc": "."},
            "taps": {"type": "int", "default": 3, "doc": "."}})"},
        {test::kPasses, R"("passes": [
            {"name": "base", "shader": "a.frag", "reads": ["color", "depth"], "writes": ["pyramid", "ids", "color"],
             "buffers": {"list": "write", "args": "write", "sums": "read"}},
            {"name": "rest", "shader": "a.frag", "writes": ["chain"]},
            {"name": "last", "shader": "a.frag", "writes": ["small"]},
            {"name": "wipe", "kind": "clear", "writes": ["stack"], "value": [0, 0.5, 1, 1]})" +
                            (passes.empty() ? "" : ", " + passes) + "]"},
    };
}

const PassSpec& last_pass(const EffectManifest& manifest) {
    return manifest.passes.back();
}

/// The last pass of a manifest without faults.
struct Made {
    explicit Made(const std::string& pass)
        : folder(demo_manifest(workshop(pass))), manifest(folder.sound_manifest()) {
        if (manifest.passes.empty()) manifest.passes.emplace_back();
    }
    const PassSpec* operator->() const { return &last_pass(manifest); }
    EffectFolder folder;
    EffectManifest manifest;
};

TEST(ManifestPasses, KeepADrawWithLevelsAndTurns) {
    const Made pass(R"({"name": "down", "shader": "b.frag", "repeat": 3, "max_iterations": 64,
        "reads": [{"pyramid": {"filter": "linear", "outside": "weight_zero", "level": "pass.index"}}, {"chain": {"level": 2}}],
        "writes": [{"pyramid": {"level": "pass.index + 1"}}]})");
    EXPECT_TRUE(pass->draw());
    EXPECT_EQ(pass->repeat, (CountSpec{3, ""}));
    EXPECT_EQ(pass->max_iterations, 64);
    EXPECT_EQ(pass->reads[0].filter, gpu::Filter::linear);
    EXPECT_EQ(pass->reads[0].wrap, gpu::Wrap::zero);
    EXPECT_EQ(pass->reads[0].level, (TurnIndex{0, true}));
    EXPECT_EQ(pass->reads[1].level, (TurnIndex{2, false}));
    EXPECT_EQ(pass->writes[0].level, (TurnIndex{1, true}));
    EXPECT_EQ(pass->writes[0].level.in_turn(2), 3);
    EXPECT_EQ(pass->reads[1].level->in_turn(2), 2);

    const Made up(
        R"({"name": "up", "shader": "b.frag", "repeat": 2, "reads": [{"pyramid": {"level": "pass.index+2"}}],
        "writes": [{"stack": {"layer": "pass.index"}}]})");
    EXPECT_EQ(up->reads[0].level, (TurnIndex{2, true}));
    EXPECT_EQ(up->writes[0].layer, (TurnIndex{0, true}));
    EXPECT_EQ(up->writes[0].level, TurnIndex{});
}

TEST(ManifestPasses, KeepADrawOfInstances) {
    const Made counted(
        R"({"name": "dots", "shader": "b.frag", "vertex": "d.vert", "writes": ["small"], "blend": "add",
        "instances": {"of": "points", "count": "turns", "per": {"scale": 0.25}}, "buffers": {"list": "read"}})");
    EXPECT_EQ(counted->draw()->vertex, "d.vert");
    EXPECT_EQ(counted->draw()->blend, gpu::Blend::add);
    ASSERT_TRUE(counted->draw()->instances.has_value());
    EXPECT_EQ(counted->draw()->instances->primitive, InstanceSpec::Primitive::points);
    EXPECT_EQ(counted->draw()->instances->count.param, "turns");
    EXPECT_EQ(counted->draw()->instances->grid->scale, 0.25);
    const Made indirect(
        R"({"name": "dots", "shader": "b.frag", "vertex": "d.vert", "writes": ["small"], "blend": "max",
        "instances": {"of": "quads", "indirect": "args"}})");
    EXPECT_EQ(indirect->draw()->blend, gpu::Blend::max);
    EXPECT_EQ(indirect->draw()->instances->indirect, "args");
    EXPECT_EQ(indirect->draw()->instances->primitive, InstanceSpec::Primitive::quads);
}

TEST(ManifestPasses, KeepComputeAndClear) {
    const Made tiles(
        R"({"name": "c", "kind": "compute", "shader": "c.comp", "images": {"ids": "atomic", "pyramid": "read",
        "stack": "write"}, "buffers": {"list": "read"}, "dispatch": {"tile": 16, "over": "small"}})");
    ASSERT_TRUE(tiles->compute());
    ASSERT_EQ(tiles->images.size(), 3U);
    EXPECT_EQ(tiles->images[0].kind, AccessSpec::Kind::atomic);
    EXPECT_EQ(tiles->images[1].kind, AccessSpec::Kind::read);
    EXPECT_EQ(tiles->images[2].kind, AccessSpec::Kind::write);
    EXPECT_EQ(tiles->compute()->dispatch.kind, DispatchSpec::Kind::tile);
    EXPECT_EQ(tiles->compute()->dispatch.tile.number, 16);
    EXPECT_EQ(tiles->compute()->dispatch.over, "small");
    const Made groups(R"({"name": "c", "kind": "compute", "shader": "c.comp", "buffers": {"sums": "write"},
        "dispatch": {"groups": [1, 2, 3]}})");
    EXPECT_EQ(groups->compute()->dispatch.kind, DispatchSpec::Kind::groups);
    EXPECT_EQ(groups->compute()->dispatch.groups[2], 3);
    const Made indirect(R"({"name": "c", "kind": "compute", "shader": "c.comp", "buffers": {"sums": "write"},
        "dispatch": {"indirect": "args"}})");
    EXPECT_EQ(indirect->compute()->dispatch.indirect, "args");
    const Made clear(
        R"({"name": "c", "kind": "clear", "writes": ["small", "color"], "value": [1, 0.5, 0, 2]})");
    ASSERT_TRUE(clear->clear());
    EXPECT_EQ(clear->clear()->value, (std::vector<double>{1, 0.5, 0, 2}));
}

TEST(ManifestPasses, KeepACopy) {
    const Made copy(R"({"name": "c", "kind": "copy", "from": "color", "to": "color"})");
    EXPECT_TRUE(copy->copies());
    EXPECT_FALSE(copy->runs_shader());
    ASSERT_EQ(copy->reads.size(), 1U);
    ASSERT_EQ(copy->writes.size(), 1U);
    EXPECT_EQ(copy->reads[0].name, "color");
    EXPECT_EQ(copy->writes[0].name, "color");
}

TEST(ManifestPasses, MayReadWhatTheyReplace) {
    const Made again(
        R"({"name": "x", "shader": "b.frag", "repeat": "turns", "reads": ["small"], "writes": ["small"]})");
    EXPECT_EQ(again->repeat->param, "turns");
}

/// A draw with these fields besides its name and shader.
std::string draw(const std::string& fields) {
    return R"({"name": "x", "shader": "b.frag", )" + fields + "}";
}
std::string compute(const std::string& fields) {
    return R"({"name": "x", "kind": "compute", "shader": "c.comp", "dispatch": {"tile": 8}, )" + fields + "}";
}

void expect_pass_faults(const std::vector<std::pair<std::string, Lines>>& broken) {
    for (const auto& [pass, messages] : broken) {
        Lines lines;
        for (const std::string& message : messages) lines.push_back("6: " + message);
        test::expect_faults(workshop(pass), lines);
    }
}

TEST(ManifestPasses, SayWhatIsWrongWithACopy) {
    const auto copy = [](const std::string& from, const std::string& to) {
        return R"({"name": "x", "kind": "copy", "from": ")" + from + R"(", "to": ")" + to + "\"}";
    };
    const std::string differ = "which differ in size, format or levels or have several layers: draw instead";
    expect_pass_faults(
        {{copy("color", "small"), {"pass 'x': copies 'color' to 'small', " + differ}},
         {copy("depth", "color"), {"pass 'x': copies 'depth' to 'color', " + differ}},
         {copy("pyramid", "color"), {"pass 'x': copies 'pyramid' to 'color', " + differ}},
         {copy("pyramid.prev", "color"),
          {"pass 'x': copies 'pyramid' to 'color', " + differ,
           "pass 'x': reads 'pyramid.prev', but 'pyramid' has no 'history'"}},
         {copy("colour", "color"),
          {"pass 'x': reads 'colour', which is neither an input nor a texture; did you mean 'color'?"}},
         {R"({"name": "x", "kind": "copy", "from": "color"})", {"the copy pass has no 'to'"}}});
}

TEST(ManifestPasses, SayWhatIsWrongWithADraw) {
    const std::string x = "pass 'x': ";
    expect_pass_faults({
        {draw(R"("writes": ["small"], "kind": "blit")"),
         {"'kind' is 'blit' but must be 'draw', 'compute', 'clear' or 'copy'"}},
        {draw(R"("writes": ["small"], "dispatch": {"tile": 8})"),
         {"the pass has no key 'dispatch'; it is a key of kind 'compute'"}},
        {draw(R"("writes": ["small"], "blend": "over")"),
         {"'blend' is 'over' but must be 'add', 'min' or 'max'"}},
        {draw(R"("writes": ["ids"], "blend": "max")"),
         {x + "blends into 'ids', but integers (r32ui) do not blend"}},
        {draw(R"("writes": ["stack"], "blend": "add")"),
         {x + "adds into 'stack', but rgba8 stops at 1; use a float format"}},
        {draw(R"("reads": ["small"], "writes": ["small"], "blend": "add")"),
         {x + "reads and writes 'small' while it blends"}},
        {draw(R"("reads": ["pyramid"], "writes": ["pyramid"])"),
         {x + "reads and writes 'pyramid', of which it writes one level only: name a level in the read"}},
        {draw(R"("reads": [{"pyramid": {"level": 1}}], "writes": [{"pyramid": {"level": 1}}])"),
         {x + "reads and writes 'pyramid' at the same level"}},
        {draw(
             R"("repeat": 3, "reads": [{"pyramid": {"level": 2}}], "writes": [{"pyramid": {"level": "pass.index"}}])"),
         {x + "reads and writes 'pyramid' at the same level"}},
        {draw(R"("reads": ["stack"], "writes": [{"stack": {"layer": 1}}])"),
         {x + "reads and writes 'stack', of which it writes one layer only"}},
        {draw(R"("reads": ["chain"], "writes": ["chain"])"),
         {x + "reads and writes 'chain', whose 'mips' are automatic"}},
        {draw(R"("writes": [{"pyramid": {"level": 4}}])"), {x + "the level of 'pyramid' is 4, but it has 4"}},
        {draw(R"("writes": [{"chain": {"level": 1}}])"),
         {x + "the level of 'chain' is 1, but the host fills all levels but 0"}},
        {draw(R"("writes": [{"stack": {"layer": 3}}])"), {x + "the layer of 'stack' is 3, but it has 3"}},
        {draw(R"("writes": [{"small": {"level": "pass.index"}}])"),
         {x + "the level of 'small' is 'pass.index', but the pass has no 'repeat'"}},
        {draw(R"("repeat": "turns", "writes": [{"pyramid": {"level": "pass.index + 1"}}])"),
         {x + "the level of 'pyramid' is 4 in one turn, but it has 4"}},
        {draw(R"("repeat": 2, "writes": [{"pyramid": {"level": "pass.index - 1"}}])"),
         {x + "the level of 'pyramid' is -1 in one turn, but it has 4"}},
        {draw(R"("writes": [{"pyramid": {"level": "pass.number"}}])"),
         {R"('level' is an integer, "pass.index", "pass.index + 1" or "pass.index - 1")"}},
        {draw(R"("writes": ["pyramid", "small"])"),
         {x + "writes 'pyramid' and 'small', which differ in size"}},
        {draw(R"("writes": ["pyramid", {"color": {"level": 1}}])"),
         {x + "the level of 'color' is 1, but it has 1",
          x + "writes 'pyramid' and 'color', which differ in size"}},
        {draw(R"("writes": [["small"]])"),
         {R"(a write is a name, or an object of one name with its place: {"pyramid": {"level": 1}})"}},
        {draw(R"("writes": ["small"], "reads": ["pyramid.prev"])"),
         {x + "reads 'pyramid.prev', but 'pyramid' has no 'history'"}},
        {draw(R"("writes": ["small"], "reads": [{"color": {"outside": "zero"}}])"),
         {"'outside' is 'zero' but must be 'clamp' or 'weight_zero'"}},
        {draw(R"("writes": ["small"], "repeat": "taps")"),
         {"'repeat' names 'taps', which must have a 'min' of at least 0 and a 'max' of at most 4096"}},
        {draw(R"("writes": ["small"], "repeat": 4097)"), {"'repeat' must be from 1 to 4096, not 4097"}},
        {draw(R"("writes": ["small"], "max_iterations": 70000)"),
         {"'max_iterations' must be from 1 to 60000: llvmpipe silently ends the loops of one "
          "invocation "
          "after 65535; split the work over a repeated pass"}},
        {draw(R"("writes": ["small"], "defines": {"MODE_FAST": 1})"),
         {"pass 'x' defines 'MODE_FAST', which the parameter 'mode' has as its GLSL name"}},
        {draw(R"("writes": ["small"], "defines": {"GL_X": 1})"),
         {"'GL_X' cannot name a define: letters, 0-9 and _ only; GLSL keeps GL_... and __ for itself"}},
        {draw(R"("writes": ["small"], "defines": {"texture": 1})"),
         {"pass 'x' defines 'texture', a word of GLSL or the host"}},
    });
}

TEST(ManifestPasses, SayWhatIsWrongWithInstances) {
    const std::string x = "pass 'x': ";
    const std::string vertex = R"("vertex": "d.vert", "writes": ["small"], )";
    expect_pass_faults({
        {draw(R"("writes": ["small"], "vertex": "d.vert")"),
         {"a 'vertex' shader needs 'instances' to place"}},
        {draw(R"("writes": ["small"], "instances": {"of": "quads", "count": 3})"),
         {"'instances' need a 'vertex' shader, which places them"}},
        {draw(vertex + R"("instances": {"of": "lines", "count": 3})"),
         {"'of' is 'lines' but must be 'quads' or 'points'"}},
        {draw(vertex + R"("instances": {"of": "quads"})"),
         {"'instances' have no 'count', 'per' or 'indirect' buffer"}},
        {draw(vertex + R"("instances": {"of": "quads", "count": 1, "indirect": "args"})"),
         {"'instances' are counted by their 'indirect' buffer or by 'count' and 'per', not both"}},
        {draw(vertex + R"("instances": {"of": "quads", "indirect": "arg"})"),
         {x + "is counted by the buffer 'arg', which is not declared; did you mean 'args'?"}},
        {draw(vertex + R"("instances": {"of": "quads", "indirect": "sums"})"),
         {x + "is counted by the buffer 'sums', which is not declared 'indirect'"}},
        {draw(vertex + R"("instances": {"of": "quads", "indirect": "args"}, "buffers": {"args": "atomic"})"),
         {x + "writes the buffer 'args' by which it is counted"}},
    });
}

TEST(ManifestPasses, SayWhatIsWrongWithCompute) {
    const std::string x = "pass 'x': ";
    const std::string shader =
        R"({"name": "x", "kind": "compute", "shader": "c.comp", "buffers": {"sums": "write"})";
    expect_pass_faults({
        {compute(R"("writes": ["small"], "buffers": {"sums": "write"})"),
         {"the compute pass has no key 'writes'; it is a key of kind 'draw' or 'clear'"}},
        {compute(R"("buffers": {"sums": "read"}, "images": {"ids": "read"})"),
         {x + "writes no image and no buffer"}},
        {compute(R"("buffers": {"sums": "atomic"})"),
         {x + "atomics on the buffer 'sums' need integers, not vec4"}},
        {compute(R"("buffers": {"sum": "write"})"),
         {x + "has the buffer 'sum', which is not declared; did you mean 'sums'?"}},
        {compute(R"("buffers": {"sums": "append"})"),
         {"'sums' is 'append' but must be 'read', 'write' or 'atomic'", x + "writes no image and no buffer"}},
        {compute(R"("buffers": {"sums": "write", "list.prev": "read"})"),
         {x + "reads 'list.prev', but 'list' has no 'history'"}},
        {compute(R"("images": {"pyramid": "atomic"})"),
         {x + "atomics on the image 'pyramid' need the format r32ui or r32i, not rg32f"}},
        {compute(R"("images": {"color": "write"})"), {x + "has the image 'color', which is not a texture"}},
        {compute(R"("images": {"ids.prev": "write"})"), {x + "an image is never '.prev': read 'ids.prev'"}},
        {compute(R"("images": {"chain": "write"})"),
         {x + "the image 'chain' has automatic 'mips', which only draws fill"}},
        {compute(R"("images": {"ids": "write"}, "reads": ["ids"])"),
         {x + "has 'ids' as an image and as a read"}},
        {shader + "}", {"the compute pass has no 'dispatch'"}},
        {shader + R"(, "dispatch": {"tile": 8, "groups": [1, 1, 1]}})",
         {"'dispatch' has one of 'tile', 'groups' and 'indirect'"}},
        {shader + R"(, "dispatch": {"groups": [1, 0, 1]}})", {"'groups' must be from 1 to 65535, not 0"}},
        {shader + R"(, "dispatch": {"tile": 8, "over": "smal"}})",
         {x + "dispatches over 'smal', which is not a texture; did you mean 'small'?"}},
        {shader + R"(, "dispatch": {"groups": [1, 1, 1], "over": "small"}})", {"'over' needs 'tile'"}},
        {shader + R"(, "dispatch": {"tile": 8}, "blend": "add"})",
         {"the compute pass has no key 'blend'; it is a key of kind 'draw'"}},
    });
}

TEST(ManifestPasses, SayWhatIsWrongWithAClear) {
    expect_pass_faults({
        {R"({"name": "x", "kind": "clear", "writes": ["small"]})", {"the clear pass has no 'value'"}},
        {R"({"name": "x", "kind": "clear", "value": 1})", {"the clear pass has no 'writes'"}},
        {R"({"name": "x", "kind": "clear", "writes": ["ids"], "value": 0.5})",
         {"pass 'x': 'value' has 0.5, but integers need a whole number"}},
        {R"({"name": "x", "kind": "clear", "writes": ["small"], "value": [1, 2, 3]})",
         {"'value' is one number or four, not 3"}},
        {R"({"name": "x", "kind": "clear", "writes": ["small"], "value": 1, "shader": "a.frag"})",
         {"the clear pass has no key 'shader'; it is a key of kind 'draw' or 'compute'"}},
    });
}

TEST(ManifestPasses, FollowTheOrderOfWrites) {
    const auto faults = [](const std::string& first) {
        Sections sections = workshop("");
        std::string& passes = sections[test::kPasses];
        passes.insert(passes.find("[") + 1, first + ", ");
        return test::faults_of_manifest(demo_manifest(sections));
    };
    EXPECT_EQ(faults(compute(R"("buffers": {"sums": "write", "list": "read"})")),
              Lines{"6: pass 'x': reads 'list' before any pass has written it (write or clear it in an "
                    "earlier pass; with "
                    "\"history\": true, 'list.prev' is the previous frame's)"});
    EXPECT_EQ(faults(R"({"name": "x", "kind": "compute", "shader": "c.comp", "buffers": {"sums": "write"},
        "dispatch": {"indirect": "args"}})"),
              Lines{"6: pass 'x': is counted by the buffer 'args' before any pass has written it"});
    EXPECT_EQ(faults(compute(R"("images": {"small": "read"}, "buffers": {"sums": "write"})")),
              Lines{"6: pass 'x': reads 'small' before any pass has written it (write or clear it in an "
                    "earlier pass; with "
                    "\"history\": true, 'small.prev' is the previous frame's)"});
    EXPECT_EQ(faults(draw(R"("writes": ["small"], "blend": "add")")),
              Lines{"6: pass 'x': blends into 'small' before any pass has written it"});
    EXPECT_EQ(faults(compute(R"("images": {"ids": "atomic"})")), Lines{}) << "a clear fills it";
}

TEST(ManifestPasses, StayWithinWhatEveryMachineBinds) {
    std::string inputs, reads, textures, writes, images;
    for (int i = 0; i < 33; ++i) {
        const std::string name = "i" + std::to_string(i), comma = i ? ", " : "";
        inputs += comma + '"' + name + R"(": {"role": "color"})";
        reads += comma + '"' + name + '"';
    }
    for (int i = 0; i < 9; ++i) {
        const std::string name = "t" + std::to_string(i), comma = i ? ", " : "";
        textures += comma + '"' + name + R"(": {"format": "r32f", "doc": "."})";
        writes += comma + '"' + name + '"';
        images += comma + '"' + name + R"(": "write")";
    }
    test::expect_faults(
        {{test::kInputs, R"("inputs": {)" + inputs + "}"},
         {test::kTextures, R"("textures": {)" + textures + "}"},
         {test::kPasses, R"("passes": [{"name": "one", "shader": "a.frag", "reads": [)" + reads + R"(],
            "writes": [)" + writes +
                             R"(]}, {"name": "two", "kind": "compute", "shader": "c.comp", "images": {)" +
                             images + R"(}, "dispatch": {"tile": 8}},
            {"name": "three", "shader": "a.frag", "writes": ["color"]}])"}},
        {"6: pass 'one': has 9 targets; the limit is 8",
         "6: pass 'one': has 33 samplers with those of parameters and native tables; the limit is 32",
         "6: pass 'two': has 9 images; the limit is 8"});
}

}  // namespace
}  // namespace aftershade
