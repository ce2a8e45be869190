//! Expansion of loops and templates.
//!
//! `Each` repeats its entries and replaces `{i}` by a number. `Use` inserts the entries of a template and replaces its
//! parameters. Both are expanded right after parsing, so that later code sees only plain entries with their positions.

use super::access_form::Level;
use super::error::FileErrors;
use super::form::{
    EachForm, ExportEntry, ExportForm, GraphForm, PassEntry, PassForm, PluginForm, ResourceEntry, ResourceForm,
    TemplateForm, UseForm, WorkForm,
};
use super::params::Word;
use super::spanned::{Source, Spanned};
use super::value::ValueReason;

/// Maximum number of entries created by loops and templates.
const MAX_ENTRIES: usize = 1 << 17;

/// Meanings of the names in braces, innermost last.
type Names<'n> = Vec<(&'n str, Meaning<'n>)>;

/// Meaning of a name in braces.
#[derive(Clone, Copy)]
enum Meaning<'n> {
    Number(i64),
    Word(&'n Word),
}

/// The expanded entries of a file.
#[derive(Debug)]
pub(super) struct Expanded {
    pub(super) resources: Vec<ResourceForm>,
    pub(super) passes: Vec<PassForm>,
    pub(super) exports: Vec<ExportForm>,
}

/// Expands all loops and templates, and collects errors.
pub(super) fn expand(source: Source<'_>, form: &mut GraphForm, errors: &mut FileErrors) -> Expanded {
    let (resources, passes) = (std::mem::take(&mut form.resources), std::mem::take(&mut form.passes));
    let exports = std::mem::take(&mut form.exports);
    let out = Expanded {
        resources: Vec::with_capacity(resources.len()),
        passes: Vec::with_capacity(passes.len()),
        exports: Vec::with_capacity(exports.len()),
    };
    let mut writer = Writer { source, templates: &form.templates.0, within: false, out, made: 0, errors };
    let none = Names::new();
    resources.into_iter().for_each(|entry| writer.resource(entry, &none));
    passes.into_iter().for_each(|entry| writer.pass(entry, &none));
    exports.into_iter().for_each(|entry| writer.export(entry, &none));
    writer.out
}

struct Writer<'w, 's> {
    source: Source<'s>,
    templates: &'w [(Spanned<String>, TemplateForm)],
    /// Set while the entries of a template are expanded.
    within: bool,
    out: Expanded,
    /// Number of entries created by loops and templates.
    made: usize,
    errors: &'w mut FileErrors,
}

impl Writer<'_, '_> {
    fn resource(&mut self, entry: ResourceEntry, names: &Names<'_>) {
        let mut form = match entry {
            ResourceEntry::Each(each) => return self.each(&each, names, Self::resource),
            ResourceEntry::Texture(form) => ResourceForm::Texture(form),
            ResourceEntry::Buffer(form) => ResourceForm::Buffer(form),
            ResourceEntry::Previous(form) => ResourceForm::Previous(form),
            ResourceEntry::MayAlias(form) => ResourceForm::MayAlias(form),
        };
        let mut fill = |text: &mut Spanned<String>| self.fill(text, names);
        match &mut form {
            ResourceForm::Texture(t) => {
                fill(&mut t.name);
                t.id.iter_mut().chain(&mut t.when).for_each(fill);
            }
            ResourceForm::Buffer(b) => {
                fill(&mut b.name);
                b.id.iter_mut().chain(&mut b.when).for_each(fill);
            }
            ResourceForm::Previous(p) => {
                fill(&mut p.of);
                p.when.iter_mut().for_each(fill);
            }
            ResourceForm::MayAlias(a) => [&mut a.of, &mut a.with].into_iter().chain(&mut a.when).for_each(fill),
        }
        self.out.resources.push(form);
    }

    fn pass(&mut self, entry: PassEntry, names: &Names<'_>) {
        let form = match entry {
            PassEntry::Each(each) => return self.each(&each, names, Self::pass),
            // Nested templates are not supported, which also rules out recursion.
            PassEntry::Use(used) if self.within => {
                return self.errors.push(|| self.source.value(&used.template, ValueReason::TemplateInTemplate));
            }
            PassEntry::Use(used) => return self.used(&used, names),
            PassEntry::Raster(form) => PassForm::Raster(self.work(form, names)),
            PassEntry::Compute(form) => PassForm::Compute(self.work(form, names)),
            PassEntry::Copy(form) => PassForm::Copy(self.work(form, names)),
            PassEntry::Plugin(form) => PassForm::Plugin(self.plugin(form, names)),
        };
        self.out.passes.push(form);
    }

    fn work(&mut self, mut form: WorkForm, names: &Names<'_>) -> WorkForm {
        let WorkForm { name, id, when, after, accesses, flags: _ } = &mut form;
        let own = std::iter::once(name).chain(id).chain(when).chain(after);
        own.for_each(|text| self.fill(text, names));
        for access in accesses {
            std::iter::once(&mut access.of).chain(&mut access.when).for_each(|text| self.fill(text, names));
            // The maximum of each type stands for all.
            self.number(&mut access.mip, u8::MAX - 1, names);
            self.number(&mut access.layer, u16::MAX - 1, names);
        }
        form
    }

    fn export(&mut self, entry: ExportEntry, names: &Names<'_>) {
        let mut form = match entry {
            ExportEntry::Each(each) => return self.each(&each, names, Self::export),
            ExportEntry::Keep(form) => ExportForm::Keep(form),
            ExportEntry::Readback(form) => ExportForm::Readback(form),
            ExportEntry::Forward(form) => ExportForm::Forward(form),
        };
        match &mut form {
            ExportForm::Keep(kept) | ExportForm::Readback(kept) => {
                std::iter::once(&mut kept.of).chain(&mut kept.when).for_each(|text| self.fill(text, names));
            }
            ExportForm::Forward(f) => {
                [&mut f.of, &mut f.to].into_iter().chain(&mut f.when).for_each(|text| self.fill(text, names));
                self.number(&mut f.mip, u8::MAX, names);
                self.number(&mut f.layer, u16::MAX, names);
            }
        }
        self.out.exports.push(form);
    }

    /// Replaces a text by the number it evaluates to.
    fn number<T: TryFrom<u32> + Into<u32> + Copy>(&mut self, level: &mut Level<T>, max: T, names: &Names<'_>) {
        let Level::Text(text) = level else { return };
        self.fill(text, names);
        let number = text.value.parse().ok().filter(|number: &u32| *number <= max.into());
        if number.is_none() {
            let fault = ValueReason::Number { text: text.value.clone(), max: max.into() };
            self.errors.push(|| self.source.value(text, fault));
        }
        *level = Level::Number(number.and_then(|number| number.try_into().ok()).unwrap_or(max));
    }

    fn plugin(&mut self, mut form: PluginForm, names: &Names<'_>) -> PluginForm {
        let PluginForm { name, id, when, after, slots, kind: _, params } = &mut form;
        if let (Some(params), false) = (params, names.is_empty()) {
            params.fill(self.source, |inside| meaning(inside, names));
        }
        let slots = slots.0.iter_mut().map(|(_, bound)| bound);
        let own = std::iter::once(name).chain(id).chain(when).chain(after).chain(slots);
        own.for_each(|text| self.fill(text, names));
        form
    }

    /// Expands a loop: writes its entries once for each number.
    fn each<E: Clone>(&mut self, each: &EachForm<E>, names: &Names<'_>, write: fn(&mut Self, E, &Names<'_>)) {
        let found = self.errors.count();
        let (mut from, mut count) = (each.from.clone(), each.count.clone());
        [&mut from, &mut count].into_iter().for_each(|text| self.number(text, u32::MAX, names));
        let [from, count] = [from, count].map(|number| i64::from(number.number().unwrap_or_default()));
        let mut names = names.clone();
        names.push((&each.index.value, Meaning::Number(from)));
        // An error in one iteration occurs in all. An empty loop needs no iterations.
        for turn in 0..count {
            if self.errors.count() != found || each.entries.is_empty() {
                return;
            }
            if let Some(last) = names.last_mut() {
                last.1 = Meaning::Number(from + turn * i64::from(each.step));
            }
            for entry in &each.entries {
                if !self.room(&each.index) {
                    return;
                }
                write(self, entry.clone(), &names);
            }
        }
    }

    /// Expands a template with the arguments of this use.
    fn used(&mut self, used: &UseForm, names: &Names<'_>) {
        let mut with = used.with.0.clone();
        for (_, word) in &mut with {
            self.word(word, names);
        }
        let Some((_, template)) = self.templates.iter().find(|(name, _)| name.value == used.template.value) else {
            let known = self.templates.iter().map(|(name, _)| name.value.as_str());
            let reason = super::error::FileReason::unknown("template", &used.template.value, known);
            return self.errors.push(|| self.source.error(&used.template, reason));
        };
        for (given, _) in with.iter().filter(|(given, _)| !template.params.contains(&given.value)) {
            let known = template.params.iter().map(String::as_str);
            let reason = super::error::FileReason::unknown("parameter", &given.value, known);
            self.errors.push(|| self.source.error(given, reason));
        }
        let mut inner = Names::new();
        for param in &template.params {
            match with.iter().find(|(given, _)| given.value == *param) {
                Some((_, word)) => inner.push((param, Meaning::Word(word))),
                None => {
                    let fault = ValueReason::Parameter(param.clone());
                    return self.errors.push(|| self.source.value(&used.template, fault));
                }
            }
        }
        for entry in &template.resources {
            if self.room(&used.template) {
                self.resource(entry.clone(), &inner);
            }
        }
        self.within = true;
        for entry in &template.passes {
            if self.room(&used.template) {
                self.pass(entry.clone(), &inner);
            }
        }
        self.within = false;
    }

    /// Replaces a word that consists of a single name in braces by its meaning.
    fn word(&mut self, word: &mut Word, names: &Names<'_>) {
        let Word::Text(text) = word else { return };
        let alone = text.value.strip_prefix('{').and_then(|rest| rest.strip_suffix('}'));
        match alone.and_then(|inside| meaning(inside, names)) {
            Some(found @ Word::Value(_)) => *word = found,
            _ => self.fill(text, names),
        }
    }

    /// Counts another entry. Returns `false` if the maximum is exceeded, and reports that once.
    fn room(&mut self, at: &Spanned<String>) -> bool {
        self.made += 1;
        if self.made == MAX_ENTRIES + 1 {
            self.errors.push(|| self.source.value(at, ValueReason::Entries { max: MAX_ENTRIES as u64 }));
        }
        self.made <= MAX_ENTRIES
    }

    /// Replaces names in braces: `{i}`, `{i+1}`, `{i-1}`. Outside of loops and templates, braces have no meaning.
    fn fill(&mut self, text: &mut Spanned<String>, names: &Names<'_>) {
        if names.is_empty() || !text.value.contains('{') {
            return;
        }
        let mut out = String::new();
        let mut rest = text.value.as_str();
        while let Some((before, behind)) = rest.split_once('{') {
            out += before;
            let (inside, after) = behind.split_once('}').unwrap_or((behind, ""));
            match meaning(inside, names) {
                Some(found) => out += found.text(),
                None => {
                    let known = names.iter().map(|(name, _)| *name);
                    let reason = super::error::FileReason::unknown("name in braces", inside, known);
                    return self.errors.push(|| self.source.error(text, reason));
                }
            }
            rest = after;
        }
        out += rest;
        text.value = out;
    }
}

/// Evaluates the text in braces: a name, or a number plus or minus another. Template parameters can be numbers.
fn meaning(inside: &str, names: &Names<'_>) -> Option<Word> {
    let inside = inside.trim();
    let split = inside.find(['+', '-']).unwrap_or(inside.len());
    let (name, change) = inside.split_at(split);
    let (_, found) = names.iter().rev().find(|(known, _)| *known == name.trim())?;
    let number = match (*found, change) {
        (Meaning::Word(word), "") => return Some(word.clone()),
        (Meaning::Word(word), _) => word.text().parse::<u32>().ok()?.into(),
        (Meaning::Number(number), _) => number,
    };
    let by: i64 = change.get(1..).map_or(Some(0), |by| by.trim().parse::<u32>().ok())?.into();
    Some(Word::Value((if change.starts_with('-') { number - by } else { number + by }).to_string()))
}
