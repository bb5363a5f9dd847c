# offer.zsh FOLDER LINE: what zsh offers behind LINE, in a terminal of its own, with FOLDER's completions.
zmodload zsh/zpty
zpty -b shell zsh -f -i
zpty -w shell "fpath=($1 \$fpath); autoload -Uz compinit; compinit -u -D; LISTMAX=0; setopt autolist; PS1='at''last> '"
shown=
for i in {1..100}; do
    while zpty -r -t shell line; do shown+=$line; done
    [[ $shown == *atlast* ]] && break
    sleep 0.1
done
sleep 0.5
zpty -n -w shell "$2"$'\t\t'
for i in {1..30}; do
    while zpty -r -t shell line; do print -rn -- "$line"; done
    sleep 0.1
done
zpty -d shell
